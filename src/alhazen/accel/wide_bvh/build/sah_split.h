#pragma once
/// Divides sets of primitives by the surface area heuristic; shared by the top-down builders.
///
/// Source: MacDonald and Booth, "Heuristics for Ray Tracing Using Space Subdivision", The Visual
/// Computer 6, 1990 (the cost); Wald, "On Fast Construction of SAH-based Bounding Volume
/// Hierarchies", RT 2007 (binning).
/// Differs: counts primitives in blocks of the lanes that test them together, by kind; sweeps small
/// sets exactly; keeps boxes in registers of four floats, bins all three axes in one pass, and
/// evaluates the bins in lanes if all primitives are of one kind.
/// Complexity and threads: O(n); large sets in parallel, with the same result for every number of
/// threads.

#include <cstdint>
#include <limits>
#include <span>

#include "alhazen/accel/wide_bvh/build/box4.h"
#include "alhazen/accel/wide_bvh/build/build_types.h"

namespace alhazen {

/// From this level on sets are halved, not divided by cost: the depth is bounded for every input.
inline constexpr int kMaxSahLevel = 48;
/// Minimum size of a set for a separate task.
inline constexpr std::uint32_t kParallelBuildSize = 4096;

/// The number of primitives of each kind.
using KindCounts = std::array<std::uint32_t, kLeafKinds>;

[[nodiscard]] inline std::uint32_t total(const KindCounts& counts) {
    std::uint32_t sum = 0;
    for (const std::uint32_t n : counts) sum += n;
    return sum;
}
/// The cost of the blocks that primitives fill.
[[nodiscard]] inline float blocks_cost(const KindCounts& counts, const LeafKinds& kinds) {
    float cost = 0;
    for (std::size_t k = 0; k < kLeafKinds; ++k) {
        cost += kinds[k].cost * static_cast<float>(kinds[k].blocks(counts[k]));
    }
    return cost;
}

/// A summary of references: their box, that of twice their centers, and their numbers.
struct RangeSummary {
    Box4 box, centers;
    KindCounts count{};

    void include(const BuildReference& r) {
        const Box4 b(r);
        box.include(b);
        centers.include_point(b.center2());
        ++count[r.kind];
    }
    void include(const RangeSummary& other) {
        box.include(other.box);
        centers.include(other.centers);
        for (std::size_t k = 0; k < kLeafKinds; ++k) count[k] += other.count[k];
    }
    [[nodiscard]] std::uint32_t size() const { return total(count); }
    /// The only kind in it, or kLeafKinds.
    [[nodiscard]] std::uint32_t kind() const {
        for (std::uint32_t k = 0; k < kLeafKinds; ++k) {
            if (count[k] == size()) return k;
        }
        return kLeafKinds;
    }
    /// True for a single primitive, or so few of one kind that a builder stops.
    [[nodiscard]] bool indivisible(const LeafKinds& kinds) const {
        const std::uint32_t k = kind();
        return size() == 1 || (k != kLeafKinds && size() <= kinds[k].indivisible());
    }
};

[[nodiscard]] RangeSummary summarize(std::span<const BuildReference> references);

/// Larger sets are binned, not swept.
inline constexpr std::uint32_t kSweepSize = 12;

/// A division of a set by the centers.
struct ObjectSplit {
    float cost = std::numeric_limits<float>::infinity();  ///< areas times costs of blocks
    int axis = -1;                                        ///< -1: none found
    int last_left = 0;  ///< the last bin, or rank along the axis, on the left
    Box4 left, right;   ///< boxes of the two sides
    /// For a swept set: the order of its references along the axis.
    std::array<std::uint8_t, kSweepSize> places;
};

/// The cheapest split; none if all centers coincide.
[[nodiscard]] ObjectSplit best_object_split(std::span<const BuildReference> references,
                                            const RangeSummary& all, const LeafKinds& kinds);

/// The two methods of best_object_split: by bins of the centers, and by sweeps along them for at
/// most kSweepSize references.
[[nodiscard]] ObjectSplit split_by_bins(std::span<const BuildReference> references,
                                        const RangeSummary& all, const LeafKinds& kinds);
[[nodiscard]] ObjectSplit split_by_sweeps(std::span<const BuildReference> references,
                                          const RangeSummary& all, const LeafKinds& kinds);
/// Reorders by a split of split_by_bins, its left side first; returns the size of the left side, and
/// the boxes of twice the centers of both.
std::uint32_t partition_by_bins(std::span<BuildReference> references, const RangeSummary& all,
                                const ObjectSplit& split, Box4& left_centers,
                                Box4& right_centers);

/// Reorders so that the left side comes first; returns its size and summarizes both sides.
std::uint32_t divide(std::span<BuildReference> references, const RangeSummary& all,
                     const ObjectSplit& split, RangeSummary& left, RangeSummary& right);
/// The same without a cost: separates kinds, else halves the set along the widest axis.
std::uint32_t divide_evenly(std::span<BuildReference> references, const RangeSummary& all,
                            RangeSummary& left, RangeSummary& right);

}  // namespace alhazen
