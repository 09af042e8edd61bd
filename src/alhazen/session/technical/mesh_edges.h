#pragma once
/// Edges and contours of a triangle mesh as an eye sees them.
///
/// Source and conventions: feature_curves.h. An edge is where the normals of two triangles differ
/// by more than 25 degrees (those of the corners, where the mesh has any), where more than two
/// meet, or, without normals, where one triangle faces the eye and the other does not. Of a solid,
/// whose triangles have one normal in cells with blunt edges, also where the planes of triangles
/// differ by more than 35 degrees.

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

/// `eye`: in the space of the mesh.
[[nodiscard]] std::vector<MeshEdge> mesh_edges(const TriangleMesh& mesh, const BeamApex& eye,
                                               bool of_solid);

}  // namespace alhazen
