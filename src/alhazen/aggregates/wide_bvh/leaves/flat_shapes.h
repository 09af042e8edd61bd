#pragma once
/// Polygons and rectangles in the leaves of the wide BVH: the slanted box around one, and the
/// rectangle within it, where its filter is sure of a hit.
///
/// Source: Freeman and Shapira, "Determining the Minimum-Area Encasing Rectangle for an Arbitrary
/// Closed Curve", CACM 18(7), 1975 (a side of the rectangle lies along an edge).
/// Differs: of polygons of many corners only some edges are tried.

#include <cstdint>
#include <span>
#include <vector>

#include "alhazen/aggregates/wide_bvh/leaves/leaf_bounds.h"

namespace alhazen {

/// The loops of a polygon or rectangle.
struct FlatOutline {
    std::vector<Vec3> vertices;
    std::vector<std::uint32_t> loop_ends;  ///< [loop] one past its last vertex
};
[[nodiscard]] FlatOutline flat_outline(const PrimitiveTable& table, PrimitiveId id);

/// The slanted box around a polygon; direction[2] is its normal.
[[nodiscard]] SlantedBounds bounds_of(const Polygon& polygon);

/// A point in the coordinates of two slabs.
struct SlabPoint {
    double u, v;
};
/// The least distance by which the rectangle |u| <= half_u, |v| <= half_v must be narrowed on all
/// sides to lie within the loops; infinite if there is none.
[[nodiscard]] double inset_of(std::span<const SlabPoint> corners,
                              std::span<const std::uint32_t> loop_ends, double half_u,
                              double half_v);
/// The radius of the largest disc around the middle within the loops; 0 if there is none.
[[nodiscard]] double inner_radius_of(std::span<const SlabPoint> corners,
                                     std::span<const std::uint32_t> loop_ends);

}  // namespace alhazen
