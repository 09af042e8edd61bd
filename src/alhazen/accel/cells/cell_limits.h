#pragma once
/// Common limits of the cell structures.

#include <cstddef>

namespace alhazen {

/// Maximum numbers of cells of a grid along an axis and in total.
inline constexpr int kMostAlongAxis = 1024;
inline constexpr double kMostCells = 1 << 27;

/// Least size of a heap: overlapping primitives that nearly all lie in the same cells, which finer
/// cells would not separate.
inline constexpr std::size_t kHeap = 16;
inline constexpr double kSameCells = 0.9;

}  // namespace alhazen
