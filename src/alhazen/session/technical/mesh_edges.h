#pragma once
/// Edges and contours of a triangle mesh as seen from an eye.
///
/// Source and conventions: feature_curves.h. A side of triangles is an edge if the normals of its
/// two triangles (those of the corners, if the mesh has any) differ by more than 25 degrees, or if
/// more than two triangles meet. For a solid, whose triangles have one normal in cells with blunt
/// edges, also if the planes of the triangles differ by more than 35 degrees. The contour of a mesh
/// that is itself the surface is where a triangle that faces the eye meets one that does not: rays
/// see its planes, not its normals.

#include <vector>

#include "alhazen/geometry/facets/beam_projection.h"
#include "alhazen/shapes/meshes/triangle_mesh.h"

namespace alhazen {

struct MeshEdge {
    enum class Kind { Border, Edge, Contour };
    Kind kind = Kind::Edge;
    Vec3 a, b;
    Vec3 out, other_out;  ///< normals of the two surfaces
};

enum class MeshSource {
    Itself,  ///< the mesh is the surface
    Shape,   ///< a tessellation of an exact shape
    Solid,   ///< a tessellation of a solid
};

/// The edges that `eye`, in the space of the mesh, sees.
[[nodiscard]] std::vector<MeshEdge> mesh_edges(const TriangleMesh& mesh, const BeamApex& eye,
                                               MeshSource source);

}  // namespace alhazen
