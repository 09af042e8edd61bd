#pragma once
/// Divides sets of primitives by the surface area heuristic; shared by the top-down builders.
///
/// Source: MacDonald and Booth, "Heuristics for Ray Tracing Using Space Subdivision", The Visual
/// Computer 6, 1990 (the cost); Wald, "On Fast Construction of SAH-based Bounding Volume
/// Hierarchies", RT 2007 (binning).
/// Differs: counts primitives in blocks of the lanes that test them together, by kind; sweeps small
/// sets exactly; keeps boxes in registers of four floats, bins all three axes in one pass, and
/// weighs them in lanes where all primitives are of one kind.
/// Complexity and threads: O(n); large sets in parallel, with the same result for every number of
/// threads.

#ifdef __SSE__
#include <xmmintrin.h>
#endif

#include <cstdint>
#include <limits>
#include <span>

#include "alhazen/accel/wide_bvh/build/build_types.h"

namespace alhazen {

/// From this level on sets are halved, not divided by cost: the depth is bounded for every input.
inline constexpr int kMaxSahLevel = 48;
/// Minimum size of a set for a separate task.
inline constexpr std::uint32_t kParallelBuildSize = 4096;

/// Four floats in a register; the fourth of a box is unused.
using Float4 = float __attribute__((vector_size(16)));

/// Lane by lane a < b ? a : b and a > b ? a : b. Compilers use one instruction only where they may
/// ignore NaN.
inline Float4 lesser(Float4 a, Float4 b) {
#ifdef __SSE__
    return _mm_min_ps(a, b);
#else
    return a < b ? a : b;
#endif
}
inline Float4 greater(Float4 a, Float4 b) {
#ifdef __SSE__
    return _mm_max_ps(a, b);
#else
    return a > b ? a : b;
#endif
}

struct Box4 {
    Float4 lo, hi;

    Box4() {
        constexpr float kInf = std::numeric_limits<float>::infinity();
        lo = Float4{kInf, kInf, kInf, kInf};
        hi = -lo;
    }
    explicit Box4(const BuildReference& r) {
        std::memcpy(&lo, r.lo, sizeof(lo));
        std::memcpy(&hi, r.hi, sizeof(hi));
    }
    explicit Box4(const FloatBox& box)
        : lo{box.lo[0], box.lo[1], box.lo[2], 0}, hi{box.hi[0], box.hi[1], box.hi[2], 0} {}
    void include(const Box4& b) {
        lo = lesser(b.lo, lo);
        hi = greater(b.hi, hi);
    }
    void include_point(Float4 p) {
        lo = lesser(p, lo);
        hi = greater(p, hi);
    }
    [[nodiscard]] Float4 center2() const { return lo + hi; }
    [[nodiscard]] FloatBox box() const {
        return FloatBox{{lo[0], lo[1], lo[2]}, {hi[0], hi[1], hi[2]}};
    }
    /// As FloatBox::weight.
    [[nodiscard]] float weight() const {
        const Float4 d = hi - lo;
        return d[0] * d[1] + d[1] * d[2] + d[2] * d[0] + 1e-6f * (d[0] + d[1] + d[2]) + 1e-12f;
    }
};

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
    Box4 left, right;   ///< of the two sides
    /// Of a set that was swept: the order of its references along the axis.
    std::array<std::uint8_t, kSweepSize> places;
};

/// The cheapest split; none when all centers coincide.
[[nodiscard]] ObjectSplit best_object_split(std::span<const BuildReference> references,
                                            const RangeSummary& all, const LeafKinds& kinds);

/// Reorders so that the left side comes first; returns its size and summarizes both sides.
std::uint32_t divide(std::span<BuildReference> references, const RangeSummary& all,
                     const ObjectSplit& split, RangeSummary& left, RangeSummary& right);
/// The same without a cost: separates kinds, else halves the set along the widest axis.
std::uint32_t divide_evenly(std::span<BuildReference> references, const RangeSummary& all,
                            RangeSummary& left, RangeSummary& right);

}  // namespace alhazen
