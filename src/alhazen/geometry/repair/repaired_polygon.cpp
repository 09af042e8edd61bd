#include "alhazen/geometry/repair/repaired_polygon.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "alhazen/geometry/polygon/polygon_plane.h"
#include "alhazen/geometry/polygon_sets/mending.h"

namespace alhazen {

namespace {

/// Corners farther off the plane, relative to the size of the polygon, are repaired.
constexpr double kFlatPolygon = 1e-6;
/// Polygons with corners farther off are refused.
constexpr double kBentPolygon = 1e-2;
constexpr std::size_t kMostMended = 20'000;
/// Holes of polygons with more corners are joined to their outlines on the lattice.
constexpr std::size_t kManyMended = 4096;

/// Maps between the plane of a polygon and a lattice over it.
class PlaneLattice {
  public:
    PlaneLattice(std::span<const Vec3> corners, const FacetPlane& plane) : plane_(plane) {
        u_ = normalize(perpendicular(plane.normal));
        v_ = cross(plane.normal, u_);
        Vec2 lo{HUGE_VAL, HUGE_VAL}, hi{-HUGE_VAL, -HUGE_VAL};
        for (const Vec3& p : corners) {
            const Vec2 at{dot(u_, p), dot(v_, p)};
            lo = {std::min(lo.x, at.x), std::min(lo.y, at.y)};
            hi = {std::max(hi.x, at.x), std::max(hi.y, at.y)};
        }
        middle_ = 0.5 * (lo + hi);
        step_ = 0.5 * std::max(hi.x - lo.x, hi.y - lo.y) / (kLatticeLimit - 1);
    }
    [[nodiscard]] LatticePoint down(const Vec3& p) const {
        const auto at = [&](double x) { return static_cast<std::int32_t>(std::lround(x / step_)); };
        return {at(dot(u_, p) - middle_.x), at(dot(v_, p) - middle_.y)};
    }
    [[nodiscard]] Vec3 up(LatticePoint p) const {
        return plane_.offset * plane_.normal + (middle_.x + step_ * p.x) * u_ +
               (middle_.y + step_ * p.y) * v_;
    }
    /// The distance of neighbours.
    [[nodiscard]] double step() const { return step_; }

  private:
    FacetPlane plane_;
    Vec3 u_, v_;
    Vec2 middle_;
    double step_ = 0;
};

std::vector<LatticeLoop> lattice_loops(std::span<const Vec3> corners,
                                       std::span<const std::uint32_t> ends,
                                       const PlaneLattice& lattice) {
    std::vector<LatticeLoop> loops(std::max<std::size_t>(ends.size(), 1));
    std::size_t first = 0;
    for (std::size_t k = 0; k < loops.size(); ++k) {
        const std::size_t end = ends.empty() ? corners.size() : ends[k];
        for (std::size_t i = first; i < end; ++i) loops[k].push_back(lattice.down(corners[i]));
        first = end;
    }
    return loops;
}

/// Moves corners to the plane; returns the largest distance.
double flatten_corners(std::vector<Vec3>& corners, const FacetPlane& plane) {
    double most = 0.0;
    for (Vec3& p : corners) {
        const double off = plane.at(p);
        most = std::max(most, std::abs(off));
        p -= off * plane.normal;
    }
    return most;
}

std::string three_digits(double value) {
    char text[32];
    (void)std::snprintf(text, sizeof text, "%.3g", value);
    return text;
}

double size_of_polygon(std::span<const Vec3> corners) {
    double most = 0.0;
    for (const Vec3& p : corners) most = std::max(most, length(p - corners[0]));
    return most;
}

/// The area of counter-clockwise parts, seen along the unit `normal`.
double area_of_parts(const std::vector<std::vector<Vec3>>& parts, const Vec3& normal) {
    double sum = 0.0;
    for (const std::vector<Vec3>& part : parts)
        sum += 0.5 * dot(newell_normal_of_loops(part, {}), normal);
    return sum;
}

double length_of_edges(std::span<const Vec3> loop) {
    double sum = 0.0;
    for (std::size_t i = 0; i < loop.size(); ++i) {
        sum += length(loop[i + 1 < loop.size() ? i + 1 : 0] - loop[i]);
    }
    return sum;
}
double length_of_edges(const std::vector<std::vector<Vec3>>& parts) {
    double sum = 0.0;
    for (const std::vector<Vec3>& part : parts) sum += length_of_edges(std::span(part));
    return sum;
}

/// The largest difference of the area of a polygon from that of its set on the lattice, due to
/// rounding: each edge moves by at most two steps, and coordinates are rounded.
double area_slack(std::span<const Vec3> corners, const PlaneLattice& lattice) {
    constexpr double kRounding = 1e-15;
    double reach = 0.0;
    for (const Vec3& p : corners) reach = std::max(reach, length(p));
    return (4.0 * lattice.step() + kRounding * reach) * length_of_edges(corners);
}

}  // namespace

RepairedPolygon repaired_polygon(std::span<const Vec3> corners, std::span<const std::uint32_t> ends,
                                 const FacetPlane& plane) {
    RepairedPolygon result;
    std::vector<Vec3> flat(corners.begin(), corners.end());
    const double off = flatten_corners(flat, plane);
    const double size = size_of_polygon(corners);
    if (!(size > 0.0)) return result;
    if (off > kBentPolygon * size) {
        result.refused = "polygon with corners " + three_digits(off) + " off its plane (at most " +
                         three_digits(kBentPolygon * size) + ", a hundredth of its size)";
        return result;
    }
    if (off > kFlatPolygon * size) {
        result.mended = "corners up to " + three_digits(off) + " off its plane were moved to it";
        corners = flat;
    }
    const bool many = corners.size() > kMostMended, one_loop = ends.size() <= 1;
    if (one_loop && (corners.size() <= 3 || is_convex_loop(corners, plane.normal))) {
        result.parts = convex_parts(corners, ends, plane.normal);
        return result;
    }
    if (many) {
        result.refused = "polygon of " + std::to_string(corners.size()) +
                         " corners that is not convex (at most " + std::to_string(kMostMended) +
                         ")";
        return result;
    }
    const PlaneLattice lattice(corners, plane);
    Mending mending;
    const PolygonSet set = polygon_set(lattice_loops(corners, ends, lattice), &mending);
    const double area =
        0.5 * lattice.step() * lattice.step() * static_cast<double>(twice_area(set));
    const double slack = area_slack(corners, lattice);
    const bool many_in_loops = !one_loop && corners.size() > kManyMended;
    const bool overlaps = mending.crossings + mending.overlaps > 0;
    bool faulty = !one_loop && overlaps;
    if (!faulty && !many_in_loops) {
        // Triangles on the corners cover the polygon once, and nothing beside it, if and only if
        // their areas add up to its area: their sum is at least the integral of the magnitude of
        // the winding number, and that is at least the area of the points where it is odd.
        result.parts = convex_parts(corners, ends, plane.normal);
        const double by_projection =
            result.mended.empty() ? off * length_of_edges(result.parts) : 0;
        faulty = std::abs(area_of_parts(result.parts, plane.normal) - area) > slack + by_projection;
    }
    // Triangles of a loop with repeated corners, or without area, are not those of the parts.
    const double signed_area = 0.5 * dot(newell_normal_of_loops(corners, ends), plane.normal);
    const bool differs =
        mending.repeated_points > 0 || area <= slack || std::abs(signed_area - area) > slack;
    result.crosses = faulty || (one_loop ? differs : mending.touches > 0);
    if (faulty || overlaps) {
        // Spikes that are narrower than a step leave no trace on the lattice.
        result.mended += (result.mended.empty() ? "" : "; ") +
                         (mending.any() ? to_string(mending) : "edges almost on each other");
    }
    if (!faulty && !many_in_loops) return result;
    result.parts.clear();
    for (const LatticeTriangle& t : triangulate(set)) {
        result.parts.push_back({lattice.up(t[0]), lattice.up(t[1]), lattice.up(t[2])});
    }
    return result;
}

}  // namespace alhazen
