#pragma once
/// Polygons in the order of depth along a beam, without a tree: for comparison with facet_tree.h.
///
/// Source: Heckbert and Hanrahan, "Beam Tracing Polygonal Objects", SIGGRAPH 1984 (each beam sorts
/// the polygons of the scene front to back); Newell, Newell and Sancha, "A Solution to the Hidden
/// Surface Problem", ACM National Conference 1972 (tests that make the order right; polygons that
/// hide each other in a circle are split).
/// Differs: the order is front to back.
/// Conventions: as in facet_tree.h.
/// Complexity: O(n log n) for polygons apart in depth, O(n^2) where depths overlap, for each beam.

#include <vector>

#include "alhazen/geometry/facets/facet_tree.h"

namespace alhazen {

struct DepthOrderReport {
    std::uint64_t polygons = 0;  ///< of the scene, each tested against the beam
    std::uint64_t within = 0;    ///< of these, in the beam
    std::uint64_t compared = 0;  ///< pairs
    std::uint64_t splits = 0;
};

/// The polygons that are not outside one of the sides, nearest first. `pool` gets the pieces of
/// those that were split.
[[nodiscard]] std::vector<FacetPiece> depth_order(FacetPool& pool,
                                                  std::span<const FacetPiece> polygons,
                                                  const BeamApex& apex,
                                                  const BeamProjection& projection,
                                                  const BeamSides& sides, double margin,
                                                  DepthOrderReport& report);

}  // namespace alhazen
