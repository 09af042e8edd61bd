#include "alhazen/shapes/patches/nurbs/trim_arcs.h"

#include <algorithm>
#include <cmath>

#include "alhazen/math/orientation.h"
#include "alhazen/shapes/patches/nurbs/bspline_pieces.h"

namespace alhazen {

namespace {

Vec2 in_plane(const HomogeneousPoint& p) {
    return p.w == 1.0 ? Vec2{p.x, p.y} : Vec2{p.x / p.w, p.y / p.w};
}

template <class Arc>
void fit_box(Arc& arc) {
    arc.lo = {std::min(arc.begin.x, arc.end.x), std::min(arc.begin.y, arc.end.y)};
    arc.hi = {std::max(arc.begin.x, arc.end.x), std::max(arc.begin.y, arc.end.y)};
    for (const HomogeneousPoint& point : arc.points) {
        const Vec2 p = in_plane(point);
        arc.lo = {std::min(arc.lo.x, p.x), std::min(arc.lo.y, p.y)};
        arc.hi = {std::max(arc.hi.x, p.x), std::max(arc.hi.y, p.y)};
    }
}

/// Largest distance of a control point from the middle of the chord's nearest third, an upper bound
/// of the distance from the chord.
template <class Arc>
double bend_of(const Arc& arc) {
    const Vec2 chord = arc.end - arc.begin;
    const double length2 = chord.x * chord.x + chord.y * chord.y;
    double most = 0.0;
    for (const HomogeneousPoint& point : arc.points) {
        const Vec2 p = in_plane(point) - arc.begin;
        const double along = p.x * chord.x + p.y * chord.y;
        const double s = length2 > 0.0 ? std::clamp(along / length2, 0.0, 1.0) : 0.0;
        most = std::max(most, std::hypot(p.x - s * chord.x, p.y - s * chord.y));
    }
    return most;
}

template <class Arc>
void append_flat(const Arc& arc, double flatness, int depth, std::vector<TrimArc>& arcs) {
    if (arc.straight() || depth == 0 || bend_of(arc) <= flatness) {
        arcs.push_back({.points = {arc.points.begin(), arc.points.end()},
                        .begin = arc.begin,
                        .end = arc.end,
                        .lo = arc.lo,
                        .hi = arc.hi,
                        .loop = arc.loop});
        return;
    }
    const auto [first, second] = halved(arc);
    append_flat(first, flatness, depth - 1, arcs);
    append_flat(second, flatness, depth - 1, arcs);
}

double weight_of(const TrimCurve& curve, std::size_t k) {
    return curve.weights.empty() ? 1.0 : curve.weights[k];
}

/// The control points of the Bezier pieces of a curve, end to end.
std::vector<HomogeneousRow> bezier_rows(const TrimCurve& curve) {
    HomogeneousRow row;
    for (std::size_t k = 0; k < curve.points.size(); ++k) {
        row.push_back(
            homogeneous(Vec3{curve.points[k].x, curve.points[k].y, 0.0}, weight_of(curve, k)));
    }
    const auto degree = static_cast<std::ptrdiff_t>(curve.degree);
    std::vector<HomogeneousRow> rows;
    if (curve.knots.empty()) {
        for (std::ptrdiff_t k = 0; k + degree < std::ssize(row); k += degree) {
            rows.emplace_back(row.begin() + k, row.begin() + k + degree + 1);
        }
        return rows;
    }
    std::vector<double> knots = curve.knots;
    const double lo = knots[curve.degree], hi = knots[knots.size() - curve.degree - 1];
    insert_all_knots(knots, row, static_cast<int>(curve.degree));
    for (const KnotSpan& span : knot_spans(knots, static_cast<int>(curve.degree), lo, hi)) {
        const auto first = static_cast<std::ptrdiff_t>(span.first);
        rows.emplace_back(row.begin() + first, row.begin() + first + degree + 1);
    }
    return rows;
}

}  // namespace

template <class Points>
std::pair<TrimPiece, TrimPiece> halved(const TrimArcOf<Points>& arc) {
    std::pair<TrimPiece, TrimPiece> halves;
    auto& [first, second] = halves;
    first.loop = second.loop = arc.loop;
    for (const HomogeneousPoint& point : arc.points) second.points.push_back(point);
    // The last point of each row is a point of the second half.
    for (std::size_t last = second.points.size(); last-- > 0;) {
        first.points.push_back(second.points[0]);
        for (std::size_t k = 0; k < last; ++k) {
            second.points[k] = 0.5 * (second.points[k] + second.points[k + 1]);
        }
    }
    first.begin = arc.begin;
    first.end = second.begin = in_plane(first.points.back());
    second.end = arc.end;
    fit_box(first);
    fit_box(second);
    return halves;
}
template std::pair<TrimPiece, TrimPiece> halved(const TrimArc& arc);
template std::pair<TrimPiece, TrimPiece> halved(const TrimPiece& piece);

Vec2 begin_of(const TrimCurve& curve) {
    return in_plane(bezier_rows(curve).front().front());
}
Vec2 end_of(const TrimCurve& curve) {
    return in_plane(bezier_rows(curve).back().back());
}

std::vector<TrimArc> trim_arcs(std::span<const TrimLoop> loops, double flatness) {
    constexpr int kMaxDepth = 24;
    std::vector<TrimArc> arcs;
    for (std::size_t l = 0; l < loops.size(); ++l) {
        std::vector<TrimArc> pieces;
        for (const TrimCurve& curve : loops[l]) {
            for (HomogeneousRow& row : bezier_rows(curve)) {
                TrimArc arc;
                arc.points = std::move(row);
                arc.loop = static_cast<std::uint32_t>(l);
                pieces.push_back(std::move(arc));
            }
        }
        for (std::size_t k = 0; k < pieces.size(); ++k) {
            pieces[k].begin = in_plane(pieces[k].points.front());
            // The next piece's first point, for one common value.
            pieces[k].end = in_plane(pieces[(k + 1) % pieces.size()].points.front());
            fit_box(pieces[k]);
        }
        for (const TrimArc& arc : pieces) append_flat(arc, flatness, kMaxDepth, arcs);
    }
    return arcs;
}

namespace {

/// Searches for a proper crossing of two arcs.
class ArcCrossing {
  public:
    explicit ArcCrossing(double size) : flatness_(1e-9 * size) {}

    template <class A, class B>
    bool find(const A& a, const B& b, int depth, Vec2& point) {
        // Arcs that run along each other have no proper crossing: the search is limited.
        if (++steps_ > 20000) return false;
        if (a.hi.x < b.lo.x || b.hi.x < a.lo.x || a.hi.y < b.lo.y || b.hi.y < a.lo.y) return false;
        const bool flat_a = is_flat(a), flat_b = is_flat(b);
        if ((flat_a && flat_b) || depth == 0) {
            const int a0 = orientation(b.begin, b.end, a.begin);
            const int a1 = orientation(b.begin, b.end, a.end);
            const int b0 = orientation(a.begin, a.end, b.begin);
            const int b1 = orientation(a.begin, a.end, b.end);
            point = 0.5 * (a.begin + a.end);
            return a0 * a1 < 0 && b0 * b1 < 0;
        }
        if (!flat_a && (flat_b || extent(a) >= extent(b))) {
            const auto [first, second] = halved(a);
            return find(first, b, depth - 1, point) || find(second, b, depth - 1, point);
        }
        const auto [first, second] = halved(b);
        return find(a, first, depth - 1, point) || find(a, second, depth - 1, point);
    }

  private:
    template <class Arc>
    static double extent(const Arc& arc) {
        return std::max(arc.hi.x - arc.lo.x, arc.hi.y - arc.lo.y);
    }
    template <class Arc>
    [[nodiscard]] bool is_flat(const Arc& arc) const {
        return arc.straight() || bend_of(arc) <= flatness_;
    }

    double flatness_;
    int steps_ = 0;
};

}  // namespace

std::vector<TrimCrossing> trim_crossings(std::span<const TrimArc> arcs, double size) {
    std::vector<std::uint32_t> order(arcs.size());
    for (std::size_t k = 0; k < order.size(); ++k) order[k] = static_cast<std::uint32_t>(k);
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        return std::pair(arcs[a].lo.x, a) < std::pair(arcs[b].lo.x, b);
    });
    std::vector<TrimCrossing> found;
    const auto is_known = [&](std::uint32_t a, std::uint32_t b) {
        return std::any_of(found.begin(), found.end(), [&](const TrimCrossing& crossing) {
            return crossing.first == a && crossing.second == b;
        });
    };
    std::vector<std::uint32_t> active;
    for (const std::uint32_t k : order) {
        std::erase_if(active, [&](std::uint32_t a) { return arcs[a].hi.x < arcs[k].lo.x; });
        for (const std::uint32_t other : active) {
            const std::uint32_t a = std::min(arcs[k].loop, arcs[other].loop);
            const std::uint32_t b = std::max(arcs[k].loop, arcs[other].loop);
            Vec2 point;
            if (!is_known(a, b) && ArcCrossing(size).find(arcs[k], arcs[other], 120, point)) {
                found.push_back({a, b, point});
            }
        }
        active.push_back(k);
    }
    return found;
}

}  // namespace alhazen
