#include "alhazen/renderers/beam_tracing/beam_cells.h"

namespace alhazen {

namespace {

/// Divides cells by regions and marks the parts inside.
class CellDivider {
  public:
    CellDivider(const BeamTree& tree, const std::vector<std::vector<std::uint32_t>>& behind)
        : tree_(tree), behind_(behind) {}

    /// Adds the terms of a piece to the cells, from `first` on, that lie in it.
    void add(std::uint32_t piece, std::vector<BeamCell>& cells) {
        std::vector<BeamCell> inside;
        divide(tree_.pieces[piece].seen.region, cells, inside);
        for (BeamCell& cell : inside) cell.terms.push_back({piece, {}});
        divide_by_lights(piece, inside);
        for (const std::uint32_t next : behind_[piece]) add(next, inside);
        for (BeamCell& cell : inside) cells.push_back(std::move(cell));
    }

  private:
    /// Removes `region` from `cells`.
    void divide(const PolygonSet& region, std::vector<BeamCell>& cells,
                std::vector<BeamCell>& inside) {
        std::vector<BeamCell> outside;
        for (BeamCell& cell : cells) {
            if (!cell.region.bounds().meets(region.bounds())) {
                outside.push_back(std::move(cell));
                continue;
            }
            cut(cell.region, region, cut_);
            if (!cut_.inside.empty()) inside.push_back({cut_.inside, cell.terms});
            if (!cut_.outside.empty()) outside.push_back({cut_.outside, std::move(cell.terms)});
        }
        cells = std::move(outside);
    }

    void divide_by_lights(std::uint32_t piece, std::vector<BeamCell>& cells) {
        const std::vector<BeamLight>& lights = tree_.pieces[piece].lights;
        for (std::uint32_t l = 0; l < lights.size(); ++l) {
            std::vector<BeamCell> lit;
            divide(lights[l].part.region, cells, lit);
            for (BeamCell& cell : lit) {
                cell.terms.back().lights.push_back(l);
                cells.push_back(std::move(cell));
            }
        }
    }

    const BeamTree& tree_;
    const std::vector<std::vector<std::uint32_t>>& behind_;
    PolygonCut cut_;
};

}  // namespace

std::vector<std::vector<std::uint32_t>> pieces_behind(const BeamTree& tree) {
    std::vector<std::vector<std::uint32_t>> behind(tree.pieces.size());
    for (std::uint32_t p = 0; p < tree.pieces.size(); ++p) {
        const std::uint32_t left = tree.beams[tree.pieces[p].beam].piece;
        if (left != kNoFacet) behind[left].push_back(p);
    }
    return behind;
}

std::vector<BeamCell> cells_of(const BeamTree& tree,
                               const std::vector<std::vector<std::uint32_t>>& behind,
                               std::uint32_t piece) {
    std::vector<BeamCell> cells{{tree.pieces[piece].seen.region, {}}};
    CellDivider(tree, behind).add(piece, cells);
    return cells;
}

}  // namespace alhazen
