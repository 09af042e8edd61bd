#pragma once
/// Vertex normals for meshes from files: normalises those of the file, or computes them.
///
/// Conventions of make_normals_unit: normals of any length are normalised; a zero or nonfinite
/// normal is replaced by the area-weighted mean normal of the vertex's triangles, or by +z if that
/// is zero too.

#include "alhazen/shapes/meshes/triangle_mesh.h"

namespace alhazen {

/// Normalises the normals; no effect on a mesh without. Precondition: indices are in range.
void make_normals_unit(TriangleMesh& mesh);

/// Sets the normal of every vertex to the area-weighted mean normal of the triangles that have a
/// vertex at its position, so that a file that repeats its vertices for every triangle becomes as
/// smooth as one that shares them. If the sum vanishes (both sides of a sheet), the mean is over
/// the triangles of the vertex itself, or +z.
/// Precondition: indices are in range.
void make_smooth_normals(TriangleMesh& mesh);

}  // namespace alhazen
