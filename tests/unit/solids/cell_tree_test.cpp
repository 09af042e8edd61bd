// The octree of cells: visits find the edges between leaves, each once.

#include "alhazen/solids/triangles/cell_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <tuple>

#include "support/random.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::Random;

bool is_less(const CellTree::Edge& a, const CellTree::Edge& b) {
    return std::tie(a.axis, a.from, a.length, a.cells) <
           std::tie(b.axis, b.from, b.length, b.cells);
}
bool are_equal(const CellTree::Edge& a, const CellTree::Edge& b) {
    return !is_less(a, b) && !is_less(b, a);
}

/// The edges of leaves, sorted.
std::vector<CellTree::Edge> sorted(const CellTree& tree, std::vector<CellTree::Edge> edges) {
    std::erase_if(edges, [&](const CellTree::Edge& edge) {
        return !std::all_of(edge.cells.begin(), edge.cells.end(),
                            [&](std::uint32_t c) { return tree.is_leaf(c); });
    });
    std::sort(edges.begin(), edges.end(), is_less);
    return edges;
}

TEST(CellTree, VisitsFindEachEdgeOnce) {
    Random random(3);
    CellTree tree(64), at_once(64);
    std::vector<CellTree::Edge> edges, all;
    const auto visit = [&] {
        tree.visit_new_edges([&](const CellTree::Edge& edge) { edges.push_back(edge); });
    };
    for (int round = 0; round < 30; ++round) {
        for (int k = 0; k < 4; ++k) {
            const auto cell =
                static_cast<std::uint32_t>(random.below(static_cast<int>(tree.count())));
            if (!tree.is_leaf(cell) || tree[cell].size == 1) continue;
            tree.split(cell);
            at_once.split(cell);
        }
        visit();
    }
    const std::size_t before = edges.size();
    visit();
    EXPECT_EQ(edges.size(), before);
    at_once.visit_new_edges([&](const CellTree::Edge& edge) { all.push_back(edge); });
    all = sorted(at_once, all);
    edges = sorted(tree, edges);
    EXPECT_GT(all.size(), 300u);
    EXPECT_EQ(std::adjacent_find(all.begin(), all.end(), are_equal), all.end());
    EXPECT_TRUE(std::equal(all.begin(), all.end(), edges.begin(), edges.end(), are_equal));
}

TEST(CellTree, EdgesLieBetweenTheirCells) {
    Random random(4);
    CellTree tree(32);
    while (tree.count() < 400) {
        const auto cell = static_cast<std::uint32_t>(random.below(static_cast<int>(tree.count())));
        if (tree.is_leaf(cell) && tree[cell].size > 1) tree.split(cell);
    }
    std::size_t ends = 0;
    tree.visit_new_edges([&](const CellTree::Edge& edge) {
        for (std::uint32_t side = 0; side < 4; ++side) {
            const CellTree::Cell& cell = tree[edge.cells[side]];
            for (std::uint32_t k = 0; k < 3; ++k) {
                const std::uint32_t axis = (edge.axis + k) % 3;
                const std::uint32_t lo = edge.from[axis], end = cell.at[axis] + cell.size;
                // Along the edge the cell contains it; across, it is on the cell's border, unless
                // the cell is two of the four.
                EXPECT_LE(cell.at[axis], lo);
                EXPECT_LE(k == 0 ? lo + edge.length : lo, end);
                if (k == 0) continue;
                const bool twice = edge.cells[side] == edge.cells[side ^ k];
                const std::uint32_t border = (side >> (k - 1) & 1) != 0 ? cell.at[axis] : end;
                EXPECT_TRUE(twice || lo == border);
            }
        }
        ++ends;
    });
    EXPECT_GT(ends, 1000u);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
