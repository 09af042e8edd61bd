#pragma once
/// Lets a policy of statistics see which cell a ray is in, and which bound it is tested against,
/// where it asks for that; policies that only count are told nothing, at no cost.
///
/// Conventions: numbers are those of the accelerator: a cell of a grid, a leaf of an octree or a
/// k-d tree, a node of a hierarchy; of a class of rays how deep it is in its tree, from 1. Told at
/// the moment at which it is counted.

#include <cstddef>

namespace alhazen {

/// The ray is in this cell or leaf.
template <class Stats>
void note_cell(const Stats& stats, std::size_t cell) {
    if constexpr (requires { stats.cell(cell); }) stats.cell(cell);
}

/// The ray was tested against the bound of this node.
template <class Stats>
void note_bound(const Stats& stats, std::size_t node, bool met) {
    if constexpr (requires { stats.bound(node, met); }) stats.bound(node, met);
}

}  // namespace alhazen
