#pragma once
/// Parts of a surface on an octree: crossings of edges, vertices in cells, faces around edges.
///
/// Conventions: vertices have numbers; a cell has one for each sheet of the surface in it
/// (cell_sheets.h).

#include <array>
#include <cstdint>

#include "alhazen/solids/solid_coordinates.h"
#include "alhazen/solids/triangles/cell_tree.h"

namespace alhazen {

/// A crossing of the surface with an edge.
struct SurfaceCrossing {
    Vec3 point, normal;
    std::uint32_t material = 0;
    SolidCoordinates::Place place;  ///< where the surface has its texture coordinates
};

/// An edge of the tree that the surface crosses.
struct SurfaceEdge {
    CellTree::Edge at;
    SurfaceCrossing met;
    bool leaves = false;  ///< the solid is left along the axis
    bool is_near = false;
    std::array<std::uint32_t, 4> vertices{};  ///< [place in `at.cells`]

    /// Places in `at.cells`, counterclockwise from outside.
    [[nodiscard]] std::array<std::size_t, 4> ring() const {
        return leaves ? std::array<std::size_t, 4>{0, 1, 3, 2}
                      : std::array<std::size_t, 4>{0, 2, 3, 1};
    }
};

/// The vertex of a sheet.
struct SurfaceVertex {
    Vec3 point, normal;
    std::uint32_t material = 0;
    bool smooth = true, is_near = false;
};

/// The polygon of three or four vertices around an edge.
struct SurfaceFace {
    std::array<std::uint32_t, 4> vertices{};  ///< counterclockwise from outside
    std::size_t count = 0;
    /// The triangles, as places of `vertices`.
    std::array<std::array<std::size_t, 3>, 2> triangles{};

    [[nodiscard]] std::size_t triangle_count() const { return count - 2; }
    /// The vertices of a triangle.
    [[nodiscard]] std::array<std::uint32_t, 3> triangle(std::size_t k) const {
        const auto& t = triangles[k];
        return {vertices[t[0]], vertices[t[1]], vertices[t[2]]};
    }
};

}  // namespace alhazen
