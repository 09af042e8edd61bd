#pragma once
/// Triangles of a glTF primitive with morph targets applied, and the joints of its vertices.
///
/// Source: Khronos, "glTF 2.0 Specification", 2021, section 3.7.2.
/// Differs: triangles of zero area are kept; unused vertices are dropped.
/// Conventions: texture coordinates are flipped so that v runs upward. A mesh without normals in
/// the file keeps none and is shaded flat, as the specification requires.

#include <span>

#include "alhazen/formats/gltf/document/gltf_budget.h"
#include "alhazen/formats/gltf/document/gltf_document.h"
#include "alhazen/shapes/meshes/triangle_mesh.h"

namespace alhazen::gltf {

/// Joints of the vertices and their weights: `per_vertex` of each.
struct VertexJoints {
    std::size_t per_vertex = 0;         ///< 0: no joints
    std::vector<std::uint32_t> joints;  ///< [vertex][per_vertex]
    std::vector<double> weights;        ///< [vertex][per_vertex]
};

struct PrimitiveGeometry {
    TriangleMesh mesh;
    VertexJoints joints;
};

/// True for the modes that form triangles.
[[nodiscard]] bool makes_surface(PrimitiveMode mode);

/// Vertex numbers of the triangles of a list, strip or fan that runs through `order`.
[[nodiscard]] std::vector<std::array<std::uint32_t, 3>> triangles_of(
    PrimitiveMode mode, std::span<const std::uint32_t> order);

/// The triangles of a primitive; empty if it has no triangles or no positions. `weights`: of the
/// morph targets; missing ones are zero. `with_joints`: also reads JOINTS_n and WEIGHTS_n.
[[nodiscard]] PrimitiveGeometry read_primitive(const Document& document, const Primitive& primitive,
                                               std::span<const double> weights, bool with_joints,
                                               Budget& budget);

}  // namespace alhazen::gltf
