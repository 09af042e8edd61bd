#pragma once
/// The window divided into cells in which the same pieces and lights are seen.
///
/// Conventions: cells of a piece that the eye sees; mirrored and refracted pieces, and the parts
/// that lights reach, divide it. The colour of a point is the sum of the terms of its cell.

#include <vector>

#include "alhazen/renderers/beam_tracing/beam_tree.h"

namespace alhazen {

/// What a piece adds to a cell.
struct BeamTerm {
    std::uint32_t piece = 0;
    std::vector<std::uint32_t> lights;  ///< indices into its `lights`
};

struct BeamCell {
    PolygonSet region;
    std::vector<BeamTerm> terms;  ///< the first is of the eye's piece
};

/// [piece] the pieces that are seen behind it: through beams that left it.
[[nodiscard]] std::vector<std::vector<std::uint32_t>> pieces_behind(const BeamTree& tree);

/// The cells of a piece that the eye sees.
[[nodiscard]] std::vector<BeamCell> cells_of(const BeamTree& tree,
                                             const std::vector<std::vector<std::uint32_t>>& behind,
                                             std::uint32_t piece);

}  // namespace alhazen
