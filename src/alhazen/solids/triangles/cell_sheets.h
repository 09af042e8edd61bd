#pragma once
/// The sheets of a surface in a cell of an octree: each gets a vertex of its own.
///
/// Source: Schaefer, Ju and Warren, "Manifold Dual Contouring", IEEE TVCG 13(3), 2007 (a vertex for
/// each sheet); Ju, Losasso, Schaefer and Warren, "Dual Contouring of Hermite Data", SIGGRAPH 2002
/// (the vertex nearest to the tangent planes).
/// Differs: sheets are joined across the faces between cells. The crossings on the border of a face
/// alternate between entries and exits; each is joined to the one beside it, on the side where the
/// surface is flatter. Both cells at a face see the same joins, so two faces of the surface meet at
/// each line between vertices, and those at a vertex are one fan.
/// Conventions: lengths of the tree are in units of its smallest cells. Threads: used by one
/// thread. Complexity: O(n log n) for n crossings of a cell.

#include <cstdint>
#include <span>
#include <vector>

#include "alhazen/solids/triangles/surface_faces.h"

namespace alhazen {

class CellSheets {
  public:
    CellSheets(const CellTree& tree, const std::vector<SurfaceEdge>& edges)
        : tree_(tree), edges_(edges) {}

    /// Finds the sheets in a cell with the given crossed edges. Returns their number.
    std::size_t find(std::uint32_t cell, std::span<const std::uint32_t> uses);
    /// The sheet of a use.
    [[nodiscard]] std::uint32_t sheet(std::size_t use) const { return sheets_[use]; }

  private:
    /// A crossed edge at a face of the cell.
    struct Join {
        std::uint32_t neighbour, use;
        std::uint64_t around = 0;  ///< its middle along the border of the face, if it is needed
    };

    void join(std::uint32_t cell, std::span<const std::uint32_t> uses, std::span<Join> at_face);
    /// How far along the border of the face between two cells the middle of an edge is.
    [[nodiscard]] std::uint64_t along_border(std::uint32_t cell, std::uint32_t neighbour,
                                             const CellTree::Edge& edge) const;
    /// How flat the surface is between two crossings: 1 in a plane.
    [[nodiscard]] static double flatness(const SurfaceCrossing& a, const SurfaceCrossing& b);
    std::uint32_t root(std::uint32_t use) const;
    void unite(std::uint32_t a, std::uint32_t b);

    const CellTree& tree_;
    const std::vector<SurfaceEdge>& edges_;
    std::vector<Join> joins_;
    std::vector<std::uint32_t> sheets_;  ///< [use] while sheets are joined, another use or itself
};

/// The vertex of a sheet with these crossings, in a box. `alone`: no other sheet is in the cell.
[[nodiscard]] SurfaceVertex make_vertex(std::span<const SurfaceCrossing> crossings, bool alone,
                                        const Vec3& lo, const Vec3& hi);

}  // namespace alhazen
