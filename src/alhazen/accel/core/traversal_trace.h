#pragma once
/// Reports cells and bounds of a traversal to statistics policies that record them, at no cost for
/// policies that only count.
///
/// Conventions: numbers are those of the accelerator: a cell of a grid, a leaf of an octree or a
/// k-d tree, a node of a hierarchy; for a class of rays its depth in the tree, from 1. Reported at
/// the moment of counting.

#include <cstddef>

namespace alhazen {

/// Reports the cell or leaf that the ray is in.
template <class Stats>
void note_cell(const Stats& stats, std::size_t cell) {
    if constexpr (requires { stats.cell(cell); }) stats.cell(cell);
}

/// Reports a test against the bound of a node.
template <class Stats>
void note_bound(const Stats& stats, std::size_t node, bool met) {
    if constexpr (requires { stats.bound(node, met); }) stats.bound(node, met);
}

}  // namespace alhazen
