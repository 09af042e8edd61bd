#pragma once
/// Sorts polygons by depth along a beam without a tree, for comparison with facet_tree.h.
///
/// Source: Heckbert and Hanrahan, "Beam Tracing Polygonal Objects", SIGGRAPH 1984 (each beam sorts
/// the polygons of the scene front to back); Newell, Newell and Sancha, "A Solution to the Hidden
/// Surface Problem", ACM National Conference 1972 (tests of the order; polygons that hide each
/// other cyclically are split).
/// Differs: the order is front to back.
/// Conventions: those of facet_tree.h.
/// Complexity: O(n log n) for each beam if the depths of polygons do not overlap, O(n^2) if they
/// do.

#include <vector>

#include "alhazen/geometry/facets/facet_tree.h"

namespace alhazen {

struct DepthOrderReport {
    std::uint64_t polygons = 0;  ///< polygons of the scene, each tested against the beam
    std::uint64_t within = 0;    ///< polygons in the beam
    std::uint64_t compared = 0;  ///< pairs compared
    std::uint64_t splits = 0;
};

/// The polygons that are not outside one of the sides, nearest first. Appends the pieces of split
/// polygons to `pool`.
[[nodiscard]] std::vector<FacetPiece> depth_order(FacetPool& pool,
                                                  std::span<const FacetPiece> polygons,
                                                  const BeamApex& apex,
                                                  const BeamProjection& projection,
                                                  const BeamSides& sides, double margin,
                                                  DepthOrderReport& report);

}  // namespace alhazen
