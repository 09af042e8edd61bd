#pragma once
/// Convex pieces of planar facets in one array of points, and their division by planes.
///
/// Source: Sutherland and Hodgman, "Reentrant Polygon Clipping", CACM 17, 1974.
/// Differs: the intersection of an edge and a plane is computed from the ends in a fixed order, so
/// that two pieces that share the edge get the same point.
/// Conventions: corners run counter-clockwise seen from the side of the normal of the facet's
/// plane.

#include <cstdint>
#include <span>
#include <vector>

#include "alhazen/geometry/facets/beam_projection.h"

namespace alhazen {

struct FacetPiece {
    std::uint32_t facet = 0;
    std::uint32_t first = 0, count = 0;  ///< range of its corners
};

struct FacetPool {
    std::vector<FacetPlane> planes;  ///< [facet] unit normals
    std::vector<Vec3> points;

    [[nodiscard]] std::span<const Vec3> corners(const FacetPiece& piece) const {
        return std::span(points).subspan(piece.first, piece.count);
    }
    FacetPiece add(std::uint32_t facet, std::span<const Vec3> corners) {
        const auto first = static_cast<std::uint32_t>(points.size());
        points.insert(points.end(), corners.begin(), corners.end());
        return {facet, first, static_cast<std::uint32_t>(corners.size())};
    }
};

/// The least and the largest signed distance of points from a plane.
struct SideRange {
    double least, most;
};
[[nodiscard]] SideRange side_range(const FacetPlane& plane, std::span<const Vec3> points);

/// The intersection of the edge from `a` to `b` with a plane, given distances `at_a` and `at_b` of
/// opposite sign.
[[nodiscard]] Vec3 edge_meets(const Vec3& a, double at_a, const Vec3& b, double at_b);

/// The part of a convex loop in front of the plane by at least `margin`.
void clip_before(const FacetPlane& plane, double margin, std::span<const Vec3> loop,
                 std::vector<Vec3>& result);

/// Both parts of a convex loop. Corners nearer to the plane than `margin` belong to both.
void split_loop(const FacetPlane& plane, double margin, std::span<const Vec3> loop,
                std::vector<Vec3>& before, std::vector<Vec3>& behind);

}  // namespace alhazen
