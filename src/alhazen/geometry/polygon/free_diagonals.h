#pragma once
/// Turns diagonals of triangulated polygons that are edges elsewhere in the mesh.
///
/// Derivation: a diagonal is an edge of two triangles of its polygon. Where it is an edge of other
/// triangles too, four meet there, and the mesh is closed but no surface. The two triangles of the
/// diagonal are then cut along the other diagonal of their quadrilateral, if that is convex and the
/// other diagonal is no edge yet; otherwise the diagonal stays.
/// Conventions: vertices of equal position are one. Turned triangles keep the orientation and the
/// place of the old ones.
/// Complexity: O(n log n) for any input; a mesh without polygons costs nothing.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "alhazen/math/vec.h"

namespace alhazen {

/// The triangles of one polygon of four vertices or more: [begin, end) of the triangles of a mesh.
struct PolygonTriangles {
    std::size_t begin = 0, end = 0;
};

/// Returns how many diagonals were turned.
std::size_t free_diagonals(std::span<const Vec3> positions,
                           std::span<const PolygonTriangles> polygons,
                           std::vector<std::array<std::uint32_t, 3>>& triangles);

}  // namespace alhazen
