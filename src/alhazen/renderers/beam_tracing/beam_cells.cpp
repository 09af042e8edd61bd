#include "alhazen/renderers/beam_tracing/beam_cells.h"

#include "alhazen/renderers/beam_tracing/box_index.h"

namespace alhazen {

namespace {

/// Cells, of which some may be empty, and an index of their boxes.
struct CellList {
    explicit CellList(const LatticeBox& whole) { index.reset(whole); }
    void add(BeamCell cell) {
        if (cell.region.empty()) return;
        index.add(cell.region.bounds());
        cells.push_back(std::move(cell));
    }
    std::vector<BeamCell> cells;
    BoxIndex index;
};

/// Divides cells by regions and marks the parts inside.
class CellDivider {
  public:
    CellDivider(const BeamTree& tree, const std::vector<std::vector<std::uint32_t>>& behind,
                const CellLimit& whole)
        : tree_(tree), behind_(behind), whole_(whole) {}

    /// Adds the terms of a piece to the cells that lie in it.
    void add(std::uint32_t piece, CellList& cells) {
        const PolygonSet& region = tree_.pieces[piece].seen.region;
        CellList inside(region.bounds());
        divide(region, cells, inside.cells);
        for (BeamCell& cell : inside.cells) {
            cell.terms.push_back({piece, {}});
            inside.index.add(cell.region.bounds());
        }
        divide_by_lights(piece, inside);
        for (const std::uint32_t next : behind_[piece]) add(next, inside);
        for (BeamCell& cell : inside.cells) cells.add(std::move(cell));
    }

  private:
    /// Removes `region` from `cells`; those that it covers stay in the list, empty.
    void divide(const PolygonSet& region, CellList& cells, std::vector<BeamCell>& inside) {
        for (const std::uint32_t k : cells.index.near(region.bounds())) {
            BeamCell& cell = cells.cells[k];
            if (!cell.region.bounds().meets(region.bounds())) continue;
            cut(cell.region, region, cut_);
            if (is_small(cell.region.bounds())) {
                if (!(twice_area(cut_.inside) > twice_area(cut_.outside))) continue;
                inside.push_back(std::move(cell));
                cell = {};
                continue;
            }
            if (!cut_.inside.empty()) inside.push_back({cut_.inside, cell.terms});
            cell.region = cut_.outside;
        }
    }

    void divide_by_lights(std::uint32_t piece, CellList& cells) {
        const std::vector<BeamLight>& lights = tree_.pieces[piece].lights;
        std::vector<BeamCell> lit;
        for (std::uint32_t l = 0; l < lights.size(); ++l) {
            lit.clear();
            divide(lights[l].part.region, cells, lit);
            for (BeamCell& cell : lit) {
                cell.terms.back().lights.push_back(l);
                cells.add(std::move(cell));
            }
        }
    }

    [[nodiscard]] bool is_small(const LatticeBox& box) const {
        return double(box.hi.x) - box.lo.x < whole_.width &&
               double(box.hi.y) - box.lo.y < whole_.height;
    }

    const BeamTree& tree_;
    const std::vector<std::vector<std::uint32_t>>& behind_;
    CellLimit whole_;
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
                               std::uint32_t piece, const CellLimit& whole) {
    const PolygonSet& region = tree.pieces[piece].seen.region;
    CellList list(region.bounds());
    list.add({region, {}});
    CellDivider(tree, behind, whole).add(piece, list);
    std::erase_if(list.cells, [](const BeamCell& cell) { return cell.region.empty(); });
    return std::move(list.cells);
}

}  // namespace alhazen
