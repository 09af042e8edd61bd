#pragma once
/// Vertex normals as mesh files give them, made into what a TriangleMesh promises.
///
/// Conventions: normals of any length become unit; one that is zero or not finite is replaced by
/// the mean normal of the vertex's triangles (weighted by area), or by +z where those have none
/// either.

#include "alhazen/shapes/meshes/triangle_mesh.h"

namespace alhazen {

/// Does nothing for a mesh without normals. Precondition: indices are in range.
void make_normals_unit(TriangleMesh& mesh);

}  // namespace alhazen
