#pragma once
/// Statistics of a renderer with beams.

#include <cstdint>

namespace alhazen {

struct BeamReport {
    std::uint64_t polygons = 0;     ///< convex polygons of the scene
    std::uint64_t tree_splits = 0;  ///< of polygons by planes of the tree
    std::uint64_t tree_pieces = 0, tree_nodes = 0, tree_depth = 0;
    std::uint64_t eye_beams = 0, reflected_beams = 0, refracted_beams = 0, shadow_beams = 0;
    std::uint64_t pieces = 0;  ///< seen by all beams
    std::uint64_t hulls_tested = 0, hulls_missed = 0;
    std::uint64_t polygons_tested = 0;  ///< by all beams
    std::uint64_t cuts = 0;             ///< set operations
    double seen_area = 0;       ///< of the pieces of the eye beam and the background, over the area
                                ///< of the window: exactly 1
    double gather_seconds = 0;  ///< to build the facets and their tree
    double beam_seconds = 0;    ///< to build the tree of beams
};

}  // namespace alhazen
