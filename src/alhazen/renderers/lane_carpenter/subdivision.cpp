#include "alhazen/renderers/lane_carpenter/subdivision.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <utility>

#include "alhazen/sampling/random.h"

namespace alhazen {

namespace {

/// Smaller parts of a patch count as flat; larger ones that extend behind the eye are split.
constexpr double kLeastPart = 0x1p-24;

/// The first control point of a side, the stride, and the degree.
struct SidePoints {
    int first, stride, degree;
};
SidePoints side_points(PatchDegrees degrees, std::size_t side) {
    const int row = degrees.v + 1;
    if (side == 0) return {0, row, degrees.u};
    if (side == 1) return {degrees.u * row, 1, degrees.v};
    if (side == 2) return {degrees.v, row, degrees.u};
    return {0, 1, degrees.v};
}

/// Halves a curve of any degree.
void halve_any(const HomogeneousPoint* from, int degree, int stride, HomogeneousPoint* low,
               HomogeneousPoint* high) {
    HomogeneousPoint row[kMaxPatchOrder];
    for (int i = 0; i <= degree; ++i) row[i] = from[i * stride];
    for (int n = degree; n >= 0; --n) {
        low[(degree - n) * stride] = row[0];
        high[n * stride] = row[n];
        for (int i = 0; i < n; ++i) row[i] = 0.5 * (row[i] + row[i + 1]);
    }
}
/// Halves a cubic, coordinate by coordinate, which avoids waiting for stores of parts of points.
void halve_cubic(const HomogeneousPoint* from, int stride, HomogeneousPoint* low,
                 HomogeneousPoint* high) {
    const auto halve = [&](double HomogeneousPoint::*axis) {
        const double p0 = from[0].*axis, p1 = from[stride].*axis, p2 = from[2 * stride].*axis;
        const double p3 = from[3 * stride].*axis;
        const double p01 = 0.5 * (p0 + p1), p12 = 0.5 * (p1 + p2), p23 = 0.5 * (p2 + p3);
        const double p012 = 0.5 * (p01 + p12), p123 = 0.5 * (p12 + p23);
        const double middle = 0.5 * (p012 + p123);
        low[0].*axis = p0;
        low[stride].*axis = p01;
        low[2 * stride].*axis = p012;
        low[3 * stride].*axis = middle;
        high[0].*axis = middle;
        high[stride].*axis = p123;
        high[2 * stride].*axis = p23;
        high[3 * stride].*axis = p3;
    };
    halve(&HomogeneousPoint::x);
    halve(&HomogeneousPoint::y);
    halve(&HomogeneousPoint::z);
    halve(&HomogeneousPoint::w);
}
/// Halves curves that start `step` apart. The output must not overlap the net.
void halve_curves(const HomogeneousPoint* net, int count, int step, int degree, int stride,
                  HomogeneousPoint* low, HomogeneousPoint* high) {
    for (int k = 0; k < count * step; k += step) {
        if (degree == 3) {
            halve_cubic(net + k, stride, low + k, high + k);
        } else {
            halve_any(net + k, degree, stride, low + k, high + k);
        }
    }
}

bool comes_first(const ScreenPoint& a, const ScreenPoint& b) {
    if (a.x != b.x) return a.x < b.x;
    if (a.y != b.y) return a.y < b.y;
    return a.nearness < b.nearness;
}

/// Sum of the lengths of the rows of a net along u, or along v.
double net_length(PatchDegrees degrees, const HomogeneousPoint* net, bool along_u) {
    const int step = along_u ? degrees.v + 1 : 1;
    double sum = 0.0;
    for (int i = 0; i + (along_u ? 1 : 0) <= degrees.u; ++i) {
        for (int j = 0; j + (along_u ? 0 : 1) <= degrees.v; ++j) {
            const int k = i * (degrees.v + 1) + j;
            const HomogeneousPoint d = net[k + step] - net[k];
            sum += std::abs(d.x) + std::abs(d.y) + std::abs(d.z) + std::abs(d.w);
        }
    }
    return sum;
}

}  // namespace

void halve_net_u(PatchDegrees degrees, const HomogeneousPoint* net, HomogeneousPoint* low,
                 HomogeneousPoint* high) {
    halve_curves(net, degrees.v + 1, 1, degrees.u, degrees.v + 1, low, high);
}

void halve_net_v(PatchDegrees degrees, const HomogeneousPoint* net, HomogeneousPoint* low,
                 HomogeneousPoint* high) {
    halve_curves(net, degrees.u + 1, degrees.v + 1, degrees.v, 1, low, high);
}

ScreenChord::ScreenChord(const ScreenView& view, const ScreenPoint& a, const ScreenPoint& b) {
    const bool turned = comes_first(b, a);
    from = turned ? b : a;
    const ScreenPoint& to = turned ? a : b;
    scale = view.pixels_of_nearness(0.5 * (from.nearness + to.nearness));
    along = {to.x - from.x, to.y - from.y, scale * (to.nearness - from.nearness)};
    squared = dot(along, along);
}

bool ScreenChord::is_within(const ScreenPoint& p, double squared_distance) const {
    const Vec3 d{p.x - from.x, p.y - from.y, scale * (p.nearness - from.nearness)};
    const double place = dot(d, along);
    if (place <= 0.0) return dot(d, d) <= squared_distance;
    if (place >= squared) {
        const Vec3 beyond = d - along;
        return dot(beyond, beyond) <= squared_distance;
    }
    const Vec3 off = cross(d, along);
    return dot(off, off) <= squared_distance * squared;
}

bool Subdivision::is_row_straight(const ScreenPoint* row, int degree, int stride) const {
    if (degree == 1) return true;
    const ScreenChord chord(view_, row[0], row[degree * stride]);
    for (int i = 1; i < degree; ++i) {
        if (!chord.is_within(row[i * stride], squared_)) return false;
    }
    return true;
}

void Subdivision::judge_before_eye(PatchDegrees degrees, SubPatch& patch) const {
    patch.projects = false;
    patch.step = PatchStep::None;
    patch.first_row = 0;
    const bool behind = std::all_of(
        patch.points, patch.points + degrees.count(),
        [&](const HomogeneousPoint& p) { return view_.before_eye(p) <= 0.0 || p.w <= 0.0; });
    if (behind || is_out_of_view(degrees, patch)) return;
    const bool small_u = patch.u1 - patch.u0 <= kLeastPart;
    const bool small_v = patch.v1 - patch.v0 <= kLeastPart;
    if (small_u && small_v) return;
    const bool along_u = net_length(degrees, patch.points, true) / degrees.u >=
                         net_length(degrees, patch.points, false) / degrees.v;
    patch.step = small_v || (along_u && !small_u) ? PatchStep::SplitU : PatchStep::SplitV;
}

bool Subdivision::is_out_of_view(PatchDegrees degrees, const SubPatch& patch) const {
    const double left = grid_.left(), right = grid_.right(), top = grid_.top(),
                 bottom = grid_.bottom();
    bool a = true, b = true, c = true, d = true;
    for (int k = 0; k < degrees.count(); ++k) {
        const HomogeneousPoint& p = patch.points[k];
        a = a && p.x < left * p.w;
        b = b && p.x > right * p.w;
        c = c && p.y < top * p.w;
        d = d && p.y > bottom * p.w;
    }
    return a || b || c || d;
}

void Subdivision::straighten(PatchDegrees degrees, std::size_t side, SubPatch& patch,
                             Projected& at) const {
    const auto [first, stride, degree] = side_points(degrees, side);
    const ScreenPoint from = at[static_cast<std::size_t>(first)];
    const ScreenPoint to = at[static_cast<std::size_t>(first + degree * stride)];
    for (int i = 1; i < degree; ++i) {
        HomogeneousPoint& p = patch.points[first + i * stride];
        ScreenPoint& s = at[static_cast<std::size_t>(first + i * stride)];
        const double share = share_of_chord(s, from, to);
        s = {from.x + share * (to.x - from.x), from.y + share * (to.y - from.y),
             from.nearness + share * (to.nearness - from.nearness)};
        p = {s.x * p.w, s.y * p.w, s.nearness * p.w, p.w};
    }
}

double Subdivision::share_of_chord(const ScreenPoint& p, const ScreenPoint& a,
                                   const ScreenPoint& b) const {
    const double scale = view_.pixels_of_nearness(0.5 * (a.nearness + b.nearness));
    const Vec3 chord{b.x - a.x, b.y - a.y, scale * (b.nearness - a.nearness)};
    const Vec3 d{p.x - a.x, p.y - a.y, scale * (p.nearness - a.nearness)};
    const double squared = dot(chord, chord);
    return squared > 0.0 ? std::clamp(dot(d, chord) / squared, 0.0, 1.0) : 0.0;
}

void Subdivision::find_straight_sides(PatchDegrees degrees, SubPatch& patch, Projected& at) const {
    for (std::size_t side = 0; side < 4; ++side) {
        if (patch.is_straight(side)) continue;
        const auto [first, stride, degree] = side_points(degrees, side);
        const ScreenPoint& from = at[static_cast<std::size_t>(first)];
        const ScreenPoint& to = at[static_cast<std::size_t>(first + degree * stride)];
        if (!in_reach(from) || !in_reach(to)) continue;
        if (!is_row_straight(&from, degree, stride)) continue;
        patch.straight_sides |= static_cast<std::uint8_t>(1u << side);
        if (!clark_) continue;
        patch.chords[side] = {{view_.to_grid(from.x), view_.to_grid(from.y)},
                              {view_.to_grid(to.x), view_.to_grid(to.y)}};
        straighten(degrees, side, patch, at);
    }
}

PatchStep Subdivision::step_of(PatchDegrees degrees, const SubPatch& patch,
                               const Projected& at) const {
    const int row = degrees.v + 1;
    bool u = !patch.is_straight(0) || !patch.is_straight(2);
    for (int j = 1; j < degrees.v && !u; ++j) {
        u = !is_row_straight(&at[static_cast<std::size_t>(j)], degrees.u, row);
    }
    bool v = !patch.is_straight(1) || !patch.is_straight(3);
    for (int i = 1; i < degrees.u && !v; ++i) {
        v = !is_row_straight(&at[static_cast<std::size_t>(i * row)], degrees.v, 1);
    }
    if (!u && !v) {
        const ScreenPoint& p00 = at[0];
        const ScreenPoint& p01 = at[static_cast<std::size_t>(degrees.v)];
        const ScreenPoint& p10 = at[static_cast<std::size_t>(degrees.u * row)];
        const ScreenPoint& p11 = at[static_cast<std::size_t>(degrees.u * row + degrees.v)];
        const double scale = view_.pixels_of_nearness(0.5 * (p00.nearness + p11.nearness));
        const Vec3 twist{p00.x + p11.x - p01.x - p10.x, p00.y + p11.y - p01.y - p10.y,
                         scale * (p00.nearness + p11.nearness - p01.nearness - p10.nearness)};
        if (dot(twist, twist) > 16.0 * squared_) u = v = true;
    }
    u = u && patch.u1 - patch.u0 > kLeastPart;
    v = v && patch.v1 - patch.v0 > kLeastPart;
    if (!u && !v) return PatchStep::Draw;
    if ((u && v) || split_ == SplitRule::Both) return PatchStep::SplitBoth;
    return u ? PatchStep::SplitU : PatchStep::SplitV;
}

void Subdivision::judge(PatchDegrees degrees, SubPatch& patch) const {
    Projected at;
    double least_x = std::numeric_limits<double>::infinity(), least_y = least_x;
    double most_x = -least_x, most_y = -least_x;
    const int count = degrees.count();
    for (int k = 0; k < count; ++k) {
        const HomogeneousPoint& p = patch.points[k];
        if (!view_.in_front(p)) return judge_before_eye(degrees, patch);
        const double share = 1.0 / p.w;
        const ScreenPoint s{p.x * share, p.y * share, p.z * share};
        at[static_cast<std::size_t>(k)] = s;
        least_x = std::min(least_x, s.x);
        most_x = std::max(most_x, s.x);
        least_y = std::min(least_y, s.y);
        most_y = std::max(most_y, s.y);
    }
    patch.projects = true;
    const IndexRange rows = grid_.rows_in(least_y, most_y);
    const bool seen = keeps_seams_ ? most_x >= grid_.left() && least_x <= grid_.right()
                                   : !grid_.columns_in(least_x, most_x).empty();
    if (rows.empty() || !seen) {
        patch.step = PatchStep::None;
        return;
    }
    patch.first_row = rows.begin;
    find_straight_sides(degrees, patch, at);
    patch.step = step_of(degrees, patch, at);
}

int Subdivision::split(PatchDegrees degrees, const SubPatch& parent,
                       const std::array<SubPatch*, 4>& children) const {
    const double u = 0.5 * (parent.u0 + parent.u1), v = 0.5 * (parent.v0 + parent.v1);
    const auto inherit = [&](SubPatch& child) {
        child.piece = parent.piece;
        child.straight_sides = parent.straight_sides;
        child.chords = parent.chords;
        child.seams = parent.seams;
        child.u0 = parent.u0;
        child.u1 = parent.u1;
        child.v0 = parent.v0;
        child.v1 = parent.v1;
    };
    /// Sets the new edge between two children: side `a` of one, side `b` of the other.
    const auto join = [&](SubPatch& low, std::size_t a, SubPatch& high, std::size_t b) {
        low.straight_sides &= static_cast<std::uint8_t>(~(1u << a));
        high.straight_sides &= static_cast<std::uint8_t>(~(1u << b));
        if (!keeps_seams_) return;
        std::uint64_t bits = parent.piece;
        for (const double x : {low.u0, low.u1, low.v0, low.v1, high.u1, high.v1}) {
            bits = mix64(bits ^ std::bit_cast<std::uint64_t>(x));
        }
        low.seams[a] = bits;
        high.seams[b] = ~bits + 1;
    };
    if (parent.step != PatchStep::SplitBoth) {
        SubPatch &low = *children[0], &high = *children[1];
        inherit(low);
        inherit(high);
        if (parent.step == PatchStep::SplitU) {
            halve_net_u(degrees, parent.points, low.points, high.points);
            low.u1 = high.u0 = u;
            join(low, 1, high, 3);
        } else {
            halve_net_v(degrees, parent.points, low.points, high.points);
            low.v1 = high.v0 = v;
            join(low, 2, high, 0);
        }
        return 2;
    }
    std::array<HomogeneousPoint, kMaxPatchOrder * kMaxPatchOrder> left, right;
    halve_net_u(degrees, parent.points, left.data(), right.data());
    halve_net_v(degrees, left.data(), children[0]->points, children[1]->points);
    halve_net_v(degrees, right.data(), children[2]->points, children[3]->points);
    for (std::size_t k = 0; k < 4; ++k) {
        inherit(*children[k]);
        (k < 2 ? children[k]->u1 : children[k]->u0) = u;
        (k % 2 == 0 ? children[k]->v1 : children[k]->v0) = v;
    }
    join(*children[0], 1, *children[2], 3);
    join(*children[1], 1, *children[3], 3);
    join(*children[0], 2, *children[1], 0);
    join(*children[2], 2, *children[3], 0);
    return 4;
}

}  // namespace alhazen
