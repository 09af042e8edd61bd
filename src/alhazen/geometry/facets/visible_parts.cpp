#include "alhazen/geometry/facets/visible_parts.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "alhazen/geometry/facets/form_factor.h"

namespace alhazen {

namespace {

/// Distance, in margins of the tree, below which objects touch.
constexpr double kTouch = 8;

/// The plane through a point and an edge, the same for both directions of the edge up to its sign;
/// the normal is 0 if the three points are collinear.
FacetPlane plane_of_edge(const Vec3& point, const Vec3& a, const Vec3& b) {
    if (std::tie(b.x, b.y, b.z) < std::tie(a.x, a.y, a.z)) {
        return plane_of_edge(point, b, a).reversed();
    }
    const Vec3 normal = cross(a - point, b - point);
    const double size = length(normal);
    if (!(size > 0.0)) return {{}, 0.0};
    const Vec3 unit = normal / size;
    return {unit, dot(unit, point)};
}

/// Sets the planes through a point and the edges of a loop that runs counter-clockwise around
/// `normal`; points inside lie in front of all planes.
void set_cone(const Vec3& point, std::span<const Vec3> loop, const Vec3& normal, BeamSides& cone) {
    cone.clear();
    const bool turned = dot(normal, point - loop[0]) > 0.0;
    for (std::size_t k = 0; k < loop.size(); ++k) {
        const FacetPlane plane =
            plane_of_edge(point, loop[k], loop[k + 1 == loop.size() ? 0 : k + 1]);
        if (plane.normal == Vec3{}) continue;
        cone.push_back(turned ? plane.reversed() : plane);
    }
}

Vec3 twice_area_normal(std::span<const Vec3> loop) {
    Vec3 sum;
    for (std::size_t k = 2; k < loop.size(); ++k) {
        sum += cross(loop[k - 1] - loop[0], loop[k] - loop[0]);
    }
    return sum;
}

/// Cuts cones out of convex loops of one plane.
class PartCutter {
  public:
    PartCutter(std::span<const Vec3> polygon, double margin) : margin_(margin) {
        parts_.emplace_back(polygon.begin(), polygon.end());
    }
    void cut_out(const BeamSides& cone) {
        next_.clear();
        for (ConvexLoop& part : parts_) {
            if (misses_cone(part, cone)) {
                next_.push_back(std::move(part));
            } else {
                divide(std::move(part), cone);
            }
        }
        parts_.swap(next_);
    }
    [[nodiscard]] std::vector<ConvexLoop>& parts() { return parts_; }

  private:
    [[nodiscard]] bool misses_cone(std::span<const Vec3> part, const BeamSides& cone) const {
        return std::any_of(cone.begin(), cone.end(), [&](const FacetPlane& side) {
            return side_range(side, part).most <= margin_;
        });
    }
    /// Splits off the parts outside one side after the other; the rest, inside all, is dropped.
    void divide(ConvexLoop part, const BeamSides& cone) {
        for (const FacetPlane& side : cone) {
            split_loop(side, margin_, part, within_, outside_);
            const bool flat = outside_.empty() || side_range(side, outside_).least >= -margin_;
            if (!flat) next_.push_back(outside_);
            if (within_.empty()) return;
            part.swap(within_);
        }
    }

    double margin_;
    std::vector<ConvexLoop> parts_, next_;
    ConvexLoop within_, outside_;
};

}  // namespace

std::vector<ConvexLoop> visible_parts(const FacetTree& tree, const Vec3& point,
                                      std::span<const Vec3> polygon, FacetWalkCounts* counts) {
    const Vec3 normal = twice_area_normal(polygon);
    const double size = length(normal);
    if (polygon.size() < 3 || !(size > 0.0)) return {};
    FacetPlane plane{normal / size, 0.0};
    plane.offset = dot(plane.normal, polygon[0]);
    const double touch = kTouch * tree.margin();
    if (!(std::abs(plane.at(point)) > touch)) return {};
    BeamSides sides;
    set_cone(point, polygon, plane.normal, sides);
    if (plane.at(point) < 0.0) plane = plane.reversed();
    sides.push_back(plane);
    PartCutter cutter(polygon, tree.margin());
    FacetWalk walk(tree, {point, 1});
    FacetWalkCounts own;
    BeamSides cone;
    std::vector<Vec3> before;
    while (!cutter.parts().empty()) {
        const std::span<const FacetPiece> pieces = walk.next(sides, own);
        if (pieces.empty()) break;
        for (const FacetPiece& piece : pieces) {
            const FacetPlane& facet = tree.pool().planes[piece.facet];
            const std::span<const Vec3> corners = tree.pool().corners(piece);
            if (std::abs(facet.at(point)) <= touch || misses(corners, sides, 0.0)) continue;
            clip_before(plane, touch, corners, before);
            if (before.empty()) continue;
            set_cone(point, before, facet.normal, cone);
            cutter.cut_out(cone);
        }
    }
    if (counts != nullptr) *counts += own;
    return std::move(cutter.parts());
}

double area_of(std::span<const Vec3> loop) {
    return 0.5 * length(twice_area_normal(loop));
}

VisibleAmount visible_amount(const FacetTree& tree, const Vec3& point,
                             std::span<const Vec3> polygon) {
    VisibleAmount amount;
    for (const ConvexLoop& part : visible_parts(tree, point, polygon)) {
        amount.area += area_of(part);
        amount.solid_angle += std::abs(solid_angle(point, part));
    }
    return amount;
}

}  // namespace alhazen
