#pragma once
/// What a renderer with beams reports besides the picture.

#include <cstdint>

namespace alhazen {

struct BeamReport {
    std::uint64_t polygons = 0;     ///< convex ones of the scene
    std::uint64_t tree_splits = 0;  ///< of them, by planes of the tree
    std::uint64_t tree_pieces = 0, tree_nodes = 0, tree_depth = 0;
    std::uint64_t eye_beams = 0, reflected_beams = 0, refracted_beams = 0, shadow_beams = 0;
    std::uint64_t pieces = 0;  ///< seen by all beams
    std::uint64_t hulls_tested = 0, hulls_missed = 0;
    std::uint64_t polygons_tested = 0;  ///< by all beams together
    std::uint64_t cuts = 0;             ///< set operations
    double seen_area = 0;       ///< of the pieces of the eye and the background, as a share of the
                                ///< window: 1 but for rounding
    double gather_seconds = 0;  ///< for the facets and their tree
    double beam_seconds = 0;    ///< for the tree of beams
};

}  // namespace alhazen
