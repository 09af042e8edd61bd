#include "alhazen/renderers/lane_carpenter/scan_polygon.h"

#include <algorithm>
#include <limits>

namespace alhazen {

namespace {

/// Twice the signed area of three corners, positive if they turn from x to y.
std::int64_t doubled_area(const FixedPoint& a, const FixedPoint& b, const FixedPoint& c) {
    return (std::int64_t{b.x} - a.x) * (std::int64_t{c.y} - a.y) -
           (std::int64_t{b.y} - a.y) * (std::int64_t{c.x} - a.x);
}

void set_triangle(const ScanQuad& quad, std::array<std::uint8_t, 3> corners,
                  std::array<std::uint8_t, 3> lines, std::array<bool, 3> against,
                  ScanTriangle& triangle) {
    const auto& a = quad.corners[corners[0]];
    const auto& b = quad.corners[corners[1]];
    const auto& c = quad.corners[corners[2]];
    const std::int64_t area = doubled_area(a.at, b.at, c.at);
    triangle.empty = area == 0;
    if (triangle.empty) return;
    triangle.corners = corners;
    triangle.lines = lines;
    for (std::size_t k = 0; k < 3; ++k) {
        triangle.inner_right[k] = (area > 0) == (quad.lines[lines[k]].turned != against[k]);
    }
    triangle.least = std::min({a.nearness, b.nearness, c.nearness});
    triangle.most = std::max({a.nearness, b.nearness, c.nearness});
    const double bx = double(b.at.x) - a.at.x, by = double(b.at.y) - a.at.y;
    const double cx = double(c.at.x) - a.at.x, cy = double(c.at.y) - a.at.y;
    const double db = b.nearness - a.nearness, dc = c.nearness - a.nearness;
    const double share = 1.0 / static_cast<double>(area);
    triangle.nearness.gx = (db * cy - dc * by) * share;
    triangle.nearness.gy = (dc * bx - db * cx) * share;
    triangle.nearness.at_origin =
        a.nearness - triangle.nearness.gx * a.at.x - triangle.nearness.gy * a.at.y;
}

using Loop = std::vector<HomogeneousPoint>;

/// A total order, so that an edge is cut at the same point from both sides.
bool comes_before(const HomogeneousPoint& a, const HomogeneousPoint& b) {
    if (a.x != b.x) return a.x < b.x;
    if (a.y != b.y) return a.y < b.y;
    return a.w < b.w;
}

/// Keeps the part of a loop where `inside` is not negative.
template <class Inside>
void clip(Loop& loop, Inside&& inside) {
    Loop result;
    for (std::size_t k = 0; k < loop.size(); ++k) {
        const HomogeneousPoint& a = loop[k];
        const HomogeneousPoint& b = loop[(k + 1) % loop.size()];
        const double da = inside(a), db = inside(b);
        if (da >= 0.0) result.push_back(a);
        if ((da >= 0.0) == (db >= 0.0)) continue;
        const bool ordered = comes_before(a, b);
        const HomogeneousPoint& from = ordered ? a : b;
        const HomogeneousPoint& to = ordered ? b : a;
        const double from_distance = ordered ? da : db, to_distance = ordered ? db : da;
        result.push_back(from + (from_distance / (from_distance - to_distance)) * (to - from));
    }
    loop.swap(result);
}

}  // namespace

Vec2 ScanQuad::parameters_at(std::size_t triangle, double x, double y) const {
    const ScanTriangle& t = triangles[triangle];
    const Corner& a = corners[t.corners[0]];
    const Corner& b = corners[t.corners[1]];
    const Corner& c = corners[t.corners[2]];
    const double bx = double(b.at.x) - a.at.x, by = double(b.at.y) - a.at.y;
    const double cx = double(c.at.x) - a.at.x, cy = double(c.at.y) - a.at.y;
    const double px = x - a.at.x, py = y - a.at.y;
    const double area = bx * cy - by * cx;
    const double mb = px * cy - py * cx, mc = bx * py - by * px;
    const double wb = mb * b.share, wc = mc * c.share, wa = (area - mb - mc) * a.share;
    const double share = 1.0 / (wa + wb + wc);
    return {std::clamp((wa * a.u + wb * b.u + wc * c.u) * share, corners[0].u, corners[2].u),
            std::clamp((wa * a.v + wb * b.v + wc * c.v) * share, corners[0].v, corners[2].v)};
}

void set_quad(const ScreenView& view, const SampleGrid& grid, int degree_u, int degree_v,
              const SubPatch& patch, bool with_chords, ScanQuad& quad) {
    const int row = degree_v + 1;
    const std::array<int, 4> place{0, degree_u * row, degree_u * row + degree_v, degree_v};
    double least = std::numeric_limits<double>::infinity(), most = -least;
    for (std::size_t k = 0; k < 4; ++k) {
        const HomogeneousPoint& p = patch.points[place[k]];
        const double y = p.y / p.w;
        quad.corners[k] = {{view.to_grid(p.x / p.w), view.to_grid(y)},
                           p.z / p.w,
                           1.0 / p.w,
                           k == 1 || k == 2 ? patch.u1 : patch.u0,
                           k >= 2 ? patch.v1 : patch.v0};
        least = std::min(least, y);
        most = std::max(most, y);
    }
    quad.piece = patch.piece;
    quad.seams = patch.seams;
    const IndexRange rows = grid.rows_in(least, most);
    quad.first_row = rows.begin;
    quad.end_row = rows.end;
    for (std::size_t side = 0; side < 4; ++side) {
        const bool falls = side >= 2;  // the side is traversed against its parameter
        if (with_chords && patch.is_straight(side)) {
            quad.lines[side] = EdgeLine(patch.chords[side].from, patch.chords[side].to);
        } else {
            const FixedPoint& a = quad.corners[falls ? (side + 1) % 4 : side].at;
            const FixedPoint& b = quad.corners[falls ? side : side + 1].at;
            quad.lines[side] = EdgeLine(a, b);
        }
    }
    quad.lines[4] = EdgeLine(quad.corners[0].at, quad.corners[2].at);
    set_triangle(quad, {0, 1, 2}, {0, 1, 4}, {false, false, true}, quad.triangles[0]);
    set_triangle(quad, {0, 2, 3}, {4, 2, 3}, {false, true, true}, quad.triangles[1]);
}

bool set_outline(const ScreenView& view, const SampleGrid& grid,
                 std::vector<std::vector<HomogeneousPoint>>& loops, const NearnessPlane& plane,
                 ScanOutline& outline) {
    if (!plane.seen) return false;
    const double reach = view.reach();
    outline.lines.clear();
    double least_x = std::numeric_limits<double>::infinity(), least_y = least_x;
    double most_x = -least_x, most_y = -least_x;
    for (Loop& loop : loops) {
        const bool inside = std::all_of(loop.begin(), loop.end(), [&](const HomogeneousPoint& p) {
            return view.in_front(p) && std::abs(p.x) <= reach * p.w && std::abs(p.y) <= reach * p.w;
        });
        if (!inside) {
            clip(loop, [&](const HomogeneousPoint& p) { return view.before_eye(p); });
            clip(loop, [&](const HomogeneousPoint& p) { return reach * p.w - p.x; });
            clip(loop, [&](const HomogeneousPoint& p) { return reach * p.w + p.x; });
            clip(loop, [&](const HomogeneousPoint& p) { return reach * p.w - p.y; });
            clip(loop, [&](const HomogeneousPoint& p) { return reach * p.w + p.y; });
        }
        std::vector<FixedPoint> corners;
        for (const HomogeneousPoint& p : loop) {
            if (!(p.w > 0.0)) continue;
            const double x = std::clamp(p.x / p.w, -view.reach(), view.reach());
            const double y = std::clamp(p.y / p.w, -view.reach(), view.reach());
            corners.push_back({view.to_grid(x), view.to_grid(y)});
            least_x = std::min(least_x, x);
            most_x = std::max(most_x, x);
            least_y = std::min(least_y, y);
            most_y = std::max(most_y, y);
        }
        for (std::size_t k = 0; k < corners.size(); ++k) {
            const FixedPoint& to = corners[(k + 1) % corners.size()];
            if (corners[k].y != to.y) outline.lines.emplace_back(corners[k], to);
        }
    }
    if (outline.lines.empty() || grid.columns_in(least_x, most_x).empty()) return false;
    const IndexRange rows = grid.rows_in(least_y, most_y);
    outline.first_row = rows.begin;
    outline.end_row = rows.end;
    const double pixel = 1.0 / view.grid_per_pixel();
    outline.nearness = {plane.gx * pixel, plane.gy * pixel, plane.at_origin, true};
    return !rows.empty();
}

}  // namespace alhazen
