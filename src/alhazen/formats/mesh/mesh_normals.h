#pragma once
/// Converts vertex normals of mesh files to those that a TriangleMesh requires.
///
/// Conventions: normals of any length are normalised; a zero or nonfinite normal is replaced by the
/// area-weighted mean normal of the vertex's triangles, or by +z where that is zero too.

#include "alhazen/shapes/meshes/triangle_mesh.h"

namespace alhazen {

/// No effect on a mesh without normals. Precondition: indices are in range.
void make_normals_unit(TriangleMesh& mesh);

}  // namespace alhazen
