#pragma once
/// Tessellation of shapes within a tolerance.
///
/// Source: see patch_tessellation.h; the patches of a shape: exact_forms.h.
/// Conventions: triangles are counterclockwise from outside, with the normals of the exact surface
/// at their vertices. The mesh of a closed shape is closed after vertices of equal position are
/// merged. Faces of boxes, polygons and height fields are exact.

#include <cstdint>
#include <string>

#include "alhazen/shapes/meshes/triangle_mesh.h"
#include "alhazen/shapes/shape_list.h"

namespace alhazen {

inline constexpr const char* kTooManyTriangles = "needs more triangles than the limit";
/// Result for a closed shape without patches or faces, to be tessellated from its crossings with
/// lines (solids/triangles/solid_triangles.h).
inline constexpr const char* kNeedsLines = "has no patches";

/// Appends triangles within `tolerance`, in object space, of a prepared, valid shape. Returns an
/// empty text, or why the shape has none (for example "is endless"); nothing is appended then.
/// Precondition: tolerance > 0.
[[nodiscard]] std::string append_triangles(const AnyShape& shape, double tolerance,
                                           std::uint64_t max_triangles, TriangleMesh& mesh);

}  // namespace alhazen
