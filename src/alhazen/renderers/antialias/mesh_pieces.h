#pragma once
/// The connected pieces of a triangle mesh: triangles that share a vertex, or vertices of one
/// position, belong to one piece.
///
/// Conventions: pieces are numbered in the order of their first triangles.
/// Complexity: almost linear in vertices and triangles; 12 bytes of temporary memory per vertex.

#include <cstdint>
#include <vector>

#include "alhazen/geometry/bounds_source.h"
#include "alhazen/geometry/box.h"
#include "alhazen/shapes/meshes/triangle_mesh.h"

namespace alhazen {

/// [vertex] the first vertex of the same position.
[[nodiscard]] std::vector<std::uint32_t> first_of_position(const std::vector<Vec3>& positions);

struct MeshPieces {
    struct Piece {
        Box3 box;
        BoundingSphere sphere;  ///< around the centre of the box
    };
    std::vector<Piece> pieces;
    std::vector<std::uint32_t> of_vertex;  ///< [vertex] index of its piece, if it has one

    explicit MeshPieces(const TriangleMesh& mesh);
};

}  // namespace alhazen
