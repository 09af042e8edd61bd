#pragma once
/// The bounding bodies of shapes in the leaves of the wide BVH, which float filters test before the
/// shape itself.
///
/// Source: Kay and Kajiya, "Ray Tracing Complex Scenes", SIGGRAPH 1986 (slabs of any direction).
/// Differs: three slabs, those of the shape or of its box in its own frame, so that a rectangle or
/// a rotated instance has no empty corners.
/// Conventions: in the frame of the aggregate, in double.

#include <tuple>
#include <type_traits>

#include "alhazen/aggregates/wide_bvh/leaves/leaf_blocks.h"
#include "alhazen/primitives/primitive_table.h"

namespace alhazen {

/// The index of a shape in AnalyticShapes: its kind.
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

/// The shape of a primitive. Precondition: it is of this kind.
template <class S>
[[nodiscard]] const S& shape_of(const PrimitiveTable& table, PrimitiveId id) {
    return std::get<ShapeColumn<S>>(table.columns)
        .shapes[static_cast<std::uint32_t>(id) - table.first(column_of<S>())];
}
/// Whether a primitive is a shape of this kind without a placement.
template <class S>
[[nodiscard]] bool is_bare(const PrimitiveTable& table, PrimitiveId id) {
    if (table.kind(id) != column_of<S>()) return false;
    const std::uint32_t i = static_cast<std::uint32_t>(id) - table.first(column_of<S>());
    return std::get<ShapeColumn<S>>(table.columns).placements[i] == kNoPlacement;
}

/// Most spheres for each cylinder, cone or disc where they share blocks: a tree of few kinds has
/// fewer and fuller blocks, but the filter of cylinders takes longer than that of spheres.
inline constexpr std::uint32_t kMostSpheresPerFrustum = 8;
/// Whether the spheres of a table lie in the blocks of cylinders, cones and discs: not among
/// triangles.
[[nodiscard]] bool spheres_join(const PrimitiveTable& table);
/// The kind of leaf for a bounded primitive.
[[nodiscard]] LeafType leaf_type(const PrimitiveTable& table, PrimitiveId id);
/// True if a primitive of this kind may lie in such a leaf.
[[nodiscard]] bool may_be_in(LeafType leaf, std::uint32_t kind);

/// A cylinder around a round shape, up to the rounding of the shape's test; a sphere.
struct RoundBounds {
    Vec3 center, axis;  ///< axis: unit; of a sphere 0
    double half_height = 0, radius = 0;
    double slope = 0;  ///< largest growth of the shape's radius per unit along its axis
};

/// Precondition: the primitive is one for LeafType::Frustums.
[[nodiscard]] RoundBounds round_bounds(const PrimitiveTable& table, PrimitiveId id);

/// The parallelepiped corner + sum of a_k edge_k with a_k in [0, 1].
struct SlantedBounds {
    Vec3 corner;
    Vec3 edge[3];
    Vec3 direction[3];  ///< unit; perpendicular to the two other edges, unless these are parallel
    Vec3 pad;           ///< largest distance by which the shape extends beyond it along each axis
    bool flat = false;  ///< of a flat shape across direction[2] (flat_shapes.h)
};

/// Approximate surface area of a primitive; for shapes other than triangles, of the bounding body.
[[nodiscard]] double surface_area(const PrimitiveTable& table, PrimitiveId id);

/// For any bounded primitive.
[[nodiscard]] SlantedBounds slanted_bounds(const PrimitiveTable& table, PrimitiveId id);

}  // namespace alhazen
