#include "alhazen/geometry/repair/repaired_polygon.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

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

}  // namespace

RepairedPolygon repaired_polygon(std::span<const Vec3> corners, std::span<const std::uint32_t> ends,
                                 const FacetPlane& plane) {
    RepairedPolygon result;
    std::vector<Vec3> flat(corners.begin(), corners.end());
    const double off = flatten_corners(flat, plane);
    const double size = size_of_polygon(corners);
    if (off > kBentPolygon * size) {
        result.refused = "polygon with corners " + three_digits(off) + " off its plane";
        return result;
    }
    if (off > kFlatPolygon * size) {
        result.mended = "corners up to " + three_digits(off) + " off its plane were moved to it";
        corners = flat;
    }
    const bool many = corners.size() > kMostMended;
    if (ends.size() <= 1 && (!many || is_convex_loop(corners, plane.normal))) {
        result.parts = convex_parts(corners, ends, plane.normal);
        if (result.parts.size() == 1 || corners.size() <= 3) return result;
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
    const bool crosses = mending.crossings + mending.overlaps > 0;
    if (!crosses && (ends.size() <= 1 || corners.size() <= kManyMended)) {
        if (ends.size() > 1) result.parts = convex_parts(corners, ends, plane.normal);
        return result;
    }
    result.crosses = crosses;
    if (crosses) {
        result.mended += (result.mended.empty() ? "" : "; ") + to_string(mending);
    }
    result.parts.clear();
    for (const LatticeTriangle& t : triangulate(set)) {
        result.parts.push_back({lattice.up(t[0]), lattice.up(t[1]), lattice.up(t[2])});
    }
    return result;
}

}  // namespace alhazen
