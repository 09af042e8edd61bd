#pragma once
/// The simple bodies around shapes that the leaves of the wide BVH hold: what their filters in
/// float test before the shape itself.
///
/// Source: Kay and Kajiya, "Ray Tracing Complex Scenes", SIGGRAPH 1986 (slabs of any direction).
/// Differs: three slabs, those of the shape itself or of its box in its own frame, so that a
/// rectangle or a turned instance has no empty corners.
/// Conventions: in the frame of the aggregate, in double.

#include <type_traits>

#include "alhazen/aggregates/wide_bvh/leaves/leaf_blocks.h"
#include "alhazen/primitives/primitive_table.h"

namespace alhazen {

/// Position of a shape in AnalyticShapes: its kind.
template <class S>
constexpr std::uint32_t column_of() {
    std::uint32_t column = 0;
    const auto search = [&]<class... T>(ShapeTypes<T...>) {
        bool found = false;
        ((found = found || std::is_same_v<S, T>, column += found ? 0 : 1), ...);
    };
    search(AnalyticShapes{});
    return column;
}

/// The kind of leaf that a bounded primitive goes to.
[[nodiscard]] LeafType leaf_type(const PrimitiveTable& table, PrimitiveId id);
/// True for every primitive whose kind alone may lie in such a leaf.
[[nodiscard]] bool may_be_in(LeafType leaf, std::uint32_t kind);

/// A cylinder around a round shape, which is in it but for the rounding of its own test.
struct RoundBounds {
    Vec3 center, axis;  ///< axis: unit
    double half_height = 0, radius = 0;
    double slope = 0;  ///< by how much the radius of the shape grows along its axis, at most
};

/// Precondition: the primitive is one for LeafType::Frustums.
[[nodiscard]] RoundBounds round_bounds(const PrimitiveTable& table, PrimitiveId id);

/// The parallelepiped corner + sum of a_k edge_k with a_k in [0, 1].
struct SlantedBounds {
    Vec3 corner;
    Vec3 edge[3];
    Vec3 direction[3];  ///< unit; across the two other edges, where these are not parallel
    Vec3 pad;           ///< how far the shape may reach beyond it along each axis
};

/// About the area of a primitive's surface: of its body, where it is no triangle.
[[nodiscard]] double surface_area(const PrimitiveTable& table, PrimitiveId id);

/// Of any bounded primitive.
[[nodiscard]] SlantedBounds slanted_bounds(const PrimitiveTable& table, PrimitiveId id);

}  // namespace alhazen
