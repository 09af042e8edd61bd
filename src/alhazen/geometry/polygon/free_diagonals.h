#pragma once
/// Flips diagonals of triangulated polygons that are also edges elsewhere in the mesh.
///
/// Derivation: a diagonal is an edge of two triangles of its polygon. If it is an edge of other
/// triangles too, four meet there, and the mesh is closed but not a manifold. The two triangles of
/// the diagonal are then divided along the other diagonal of their quadrilateral, if that is convex
/// and the other diagonal is not an edge yet; otherwise the diagonal stays.
/// Conventions: vertices of equal position count as one. Flipped triangles keep the orientation and
/// the indices of the old ones.
/// Complexity: O(n log n) for any input; a mesh without polygons costs nothing.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "alhazen/math/vec.h"

namespace alhazen {

/// The triangles [begin, end) of a mesh that make up one polygon of four or more vertices.
struct PolygonTriangles {
    std::size_t begin = 0, end = 0;
};

/// Returns the number of flipped diagonals.
std::size_t free_diagonals(std::span<const Vec3> positions,
                           std::span<const PolygonTriangles> polygons,
                           std::vector<std::array<std::uint32_t, 3>>& triangles);

}  // namespace alhazen
