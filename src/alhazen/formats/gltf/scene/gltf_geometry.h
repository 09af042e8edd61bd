#pragma once
/// The triangles of a glTF primitive, with morph targets applied, and the joints of its vertices.
///
/// Source: Khronos, "glTF 2.0 Specification", 2021, section 3.7.2.
/// Differs: triangles without area stay; vertices that no triangle uses go.
/// Conventions: texture coordinates are turned so that v runs upward; without normals in the file
/// the mesh has none, which is flat shading, as the specification asks.

#include <span>

#include "alhazen/formats/gltf/document/gltf_budget.h"
#include "alhazen/formats/gltf/document/gltf_document.h"
#include "alhazen/shapes/meshes/triangle_mesh.h"

namespace alhazen::gltf {

/// Which joints move a vertex, and how much: `per_vertex` of each.
struct VertexJoints {
    std::size_t per_vertex = 0;         ///< 0: the vertices have none
    std::vector<std::uint32_t> joints;  ///< [vertex][per_vertex]
    std::vector<double> weights;        ///< [vertex][per_vertex]
};

struct PrimitiveGeometry {
    TriangleMesh mesh;
    VertexJoints joints;
};

/// True for the modes that make triangles.
[[nodiscard]] bool makes_surface(PrimitiveMode mode);

/// The vertex numbers of a strip, a fan or a list of triangles that runs through `order`.
[[nodiscard]] std::vector<std::array<std::uint32_t, 3>> triangles_of(
    PrimitiveMode mode, std::span<const std::uint32_t> order);

/// Empty when the primitive makes no surface or has no positions. `weights`: of the morph targets,
/// missing ones are zero. `with_joints`: also reads JOINTS_n and WEIGHTS_n.
[[nodiscard]] PrimitiveGeometry read_primitive(const Document& document, const Primitive& primitive,
                                               std::span<const double> weights, bool with_joints,
                                               Budget& budget);

}  // namespace alhazen::gltf
