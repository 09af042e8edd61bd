#pragma once
/// Edges and contours of a triangle mesh as an eye sees them.
///
/// Source and conventions: feature_curves.h. An edge is where the normals of two triangles differ
/// by more than 25 degrees (those of the corners, where the mesh has any) or where more than two
/// meet. Of a solid, whose triangles have one normal in cells with blunt edges, also where the
/// planes of triangles differ by more than 35 degrees. A mesh that stands for itself ends where a
/// triangle that faces the eye meets one that does not: rays see its planes, not its normals.

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
    Shape,   ///< triangles within a tolerance of an exact shape
    Solid,   ///< the same of a solid
};

/// `eye`: in the space of the mesh.
[[nodiscard]] std::vector<MeshEdge> mesh_edges(const TriangleMesh& mesh, const BeamApex& eye,
                                               MeshSource source);

}  // namespace alhazen
