#pragma once
/// Division of the window into cells in which the same pieces and lights are visible.
///
/// Conventions: the cells are those of a piece that the eye sees, divided by mirrored and refracted
/// pieces and by the parts that lights reach. The colour of a point is the sum of the terms of its
/// cell.

#include <vector>

#include "alhazen/renderers/beam_tracing/beam_tree.h"

namespace alhazen {

/// The contribution of a piece to a cell.
struct BeamTerm {
    std::uint32_t piece = 0;
    std::vector<std::uint32_t> lights;  ///< indices into its `lights`
};

struct BeamCell {
    PolygonSet region;
    std::vector<BeamTerm> terms;  ///< the first belongs to the eye's piece
};

/// [piece] the pieces seen by beams that left it.
[[nodiscard]] std::vector<std::vector<std::uint32_t>> pieces_behind(const BeamTree& tree);

/// Cells narrower and lower than this are not divided: a cell is in a region that has most of it.
struct CellLimit {
    double width = 0, height = 0;  ///< lattice units
};

/// The cells of a piece that the eye sees.
[[nodiscard]] std::vector<BeamCell> cells_of(const BeamTree& tree,
                                             const std::vector<std::vector<std::uint32_t>>& behind,
                                             std::uint32_t piece, const CellLimit& whole = {});

}  // namespace alhazen
