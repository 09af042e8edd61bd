#pragma once
/// Vertex normals for meshes of files: those of the file made unit, or made where it has none.
///
/// Conventions of make_normals_unit: normals of any length are normalised; a zero or nonfinite
/// normal is replaced by the area-weighted mean normal of the vertex's triangles, or by +z where
/// that is zero too.

#include "alhazen/shapes/meshes/triangle_mesh.h"

namespace alhazen {

/// No effect on a mesh without normals. Precondition: indices are in range.
void make_normals_unit(TriangleMesh& mesh);

/// Sets the normal of every vertex to the mean, weighted by area, of the triangles that have a
/// vertex at its position: a file that repeats its vertices for every triangle becomes as smooth as
/// one that shares them. Where the sum vanishes (both sides of a sheet) the mean is that of the
/// triangles of the vertex itself, or +z.
/// Precondition: indices are in range.
void make_smooth_normals(TriangleMesh& mesh);

}  // namespace alhazen
