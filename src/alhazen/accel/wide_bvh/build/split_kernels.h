#pragma once
/// The loops over references of one kind, compiled for several instruction sets: a box is one
/// register of eight floats where there are any, with the lower sides negated, so that one maximum
/// joins two boxes.
///
/// Conventions: results do not depend on the instruction set, except for signs of zeros.

#include <array>
#include <cstddef>
#include <cstdint>

#include "alhazen/accel/wide_bvh/build/binning.h"

namespace alhazen {

/// The bins of references of one kind: a row of boxes for each axis, and one of their numbers. All
/// parts of a bin lie at the same offset in their rows. Made by SplitKernels::fill.
struct PlainBins {
    static constexpr std::size_t kBytes = 32;  ///< of a box; a row's numbers are as far apart
    alignas(64) std::byte rows[4][kMaxBins * kBytes];
};

/// The order of a few references along each axis.
using SweepPlaces = std::array<std::array<std::uint8_t, kSweepSize>, 3>;

struct SplitKernels {
    /// Makes the bins of references.
    void (*fill)(const BuildReference* references, std::size_t size, const Binning& binning,
                 PlainBins& bins);
    /// Adds the bins of other references.
    void (*add)(PlainBins& sum, const PlainBins& bins, int count);
    /// The best split of the bins of `size` references.
    ObjectSplit (*best)(const PlainBins& bins, int count, int size, const LeafKind& kind);
    /// As partition_by_bins.
    std::uint32_t (*divide)(BuildReference* references, std::size_t size, const Binning& binning,
                            const ObjectSplit& split, Box4& left_centers, Box4& right_centers);
    /// The best split of a few references, by sweeps along each axis that is wide (-1 in its lane).
    ObjectSplit (*sweep)(const BuildReference* references, std::size_t size,
                         const SweepPlaces& places, Int4 wide, const LeafKind& kind);
};

/// Those of this machine.
[[nodiscard]] const SplitKernels& split_kernels();

}  // namespace alhazen
