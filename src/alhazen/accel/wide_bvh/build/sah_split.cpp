#include "alhazen/accel/wide_bvh/build/sah_split.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <new>
#include <utility>
#include <vector>

#include "alhazen/parallel/parallel.h"

namespace alhazen {
namespace {

constexpr int kMaxBins = 32;
constexpr std::uint32_t kSweepSize = 12;      // larger sets are binned, not swept
constexpr std::size_t kBinningChunk = 32768;  // references read by one task

using Int4 = std::int32_t __attribute__((vector_size(16)));

/// Sets the fourth lane to 0.
Float4 first_three(Float4 v) {
    Int4 bits;
    std::memcpy(&bits, &v, sizeof(bits));
    bits &= Int4{-1, -1, -1, 0};
    std::memcpy(&v, &bits, sizeof(v));
    return v;
}

/// The bins of a center along all axes; counting and dividing use the same function.
struct Binning {
    int bins;
    Float4 lo, scale;

    explicit Binning(const RangeSummary& all) : lo(first_three(all.centers.lo)) {
        const std::uint32_t size = all.size();
        bins = size < 64 ? 8 : size < 1024 ? 16 : kMaxBins;
        for (int k = 0; k < 3; ++k) {
            const float extent = all.centers.hi[k] - all.centers.lo[k];
            // A set too thin to divide has one bin.
            const float s = static_cast<float>(bins) * (1.0f - 1e-6f) / extent;
            scale[k] = extent > 0.0f && s < 1e37f ? s : 0.0f;
        }
        scale[3] = 0;
    }
    [[nodiscard]] Int4 bin(Float4 center2) const {
        const Float4 place = (first_three(center2) - lo) * scale;
        const Float4 most = Float4{1, 1, 1, 1} * static_cast<float>(bins - 1);
        return __builtin_convertvector(lesser(place, most), Int4);
    }
    /// As bin(r)[axis].
    [[nodiscard]] int bin_along(const BuildReference& r, int axis) const {
        const float place = (r.center2(axis) - lo[axis]) * scale[axis];
        const auto most = static_cast<float>(bins - 1);
        return static_cast<int>(place < most ? place : most);
    }
};

struct Bin {
    Box4 box;
    KindCounts count{};
    std::uint32_t unused = 0;

    void include(const Bin& other) {
        box.include(other.box);
        for (std::size_t k = 0; k < kLeafKinds; ++k) count[k] += other.count[k];
    }
};
/// Only the bins in use are constructed.
class Bins {
  public:
    explicit Bins(int count) {
        for (int axis = 0; axis < 3; ++axis) {
            for (int b = 0; b < count; ++b) new (&of(axis)[b]) Bin;
        }
    }
    [[nodiscard]] Bin* of(int axis) { return reinterpret_cast<Bin*>(room_) + axis * kMaxBins; }
    [[nodiscard]] const Bin* of(int axis) const {
        return reinterpret_cast<const Bin*>(room_) + axis * kMaxBins;
    }

  private:
    alignas(Bin) std::byte room_[3 * kMaxBins * sizeof(Bin)];
};

void fill(std::span<const BuildReference> references, const Binning& binning, Bins& bins) {
    for (const BuildReference& r : references) {
        const Box4 box(r);
        const Int4 place = binning.bin(box.center2());
        // Unrolled by hand: constant lanes of `place` stay in registers.
        const auto add = [&](int axis, int b) {
            Bin& bin = bins.of(axis)[b];
            bin.box.include(box);
            ++bin.count[r.kind];
        };
        add(0, place[0]);
        add(1, place[1]);
        add(2, place[2]);
    }
}

/// Calls add(total, part) for a small set; for a large one in parallel on parts, each starting as a
/// copy of `total`, combined by `merge` in order.
template <class T, class Add, class Merge>
void for_chunks(std::span<const BuildReference> all, const Add& add, const Merge& merge, T& total) {
    if (all.size() <= 2 * kBinningChunk) return add(total, all);
    std::vector<T> parts((all.size() - 1) / kBinningChunk + 1, total);
    parallel_for(all.size(), kBinningChunk, [&](std::size_t i, std::size_t j) {
        add(parts[i / kBinningChunk], all.subspan(i, j - i));
    });
    for (const T& part : parts) merge(total, part);
}

/// The cost of a side with these numbers of each kind.
struct SideCost {
    const LeafKinds& kinds;
    std::uint32_t only;  ///< the only kind, or kLeafKinds

    [[nodiscard]] float operator()(const Box4& box, const KindCounts& count) const {
        if (only == kLeafKinds) return box.weight() * blocks_cost(count, kinds);
        return box.weight() * kinds[only].cost *
               static_cast<float>(kinds[only].blocks(count[only]));
    }
};

void best_of_bins(const Bin* bins, int count, int axis, const SideCost& cost, ObjectSplit& best) {
    float right_cost[kMaxBins];
    Box4 right_box[kMaxBins];
    Bin right;
    for (int b = count - 1; b > 0; --b) {
        right.include(bins[b]);
        right_box[b] = right.box;
        right_cost[b] = total(right.count) == 0 ? 0 : cost(right.box, right.count);
    }
    const std::uint32_t all = total(right.count) + total(bins[0].count);
    Bin left;
    for (int b = 0; b + 1 < count; ++b) {
        left.include(bins[b]);
        const std::uint32_t size = total(left.count);
        if (size == 0) continue;
        if (size == all) break;
        const float sum = cost(left.box, left.count) + right_cost[b + 1];
        if (sum < best.cost) best = {sum, axis, b, left.box, right_box[b + 1]};
    }
}

ObjectSplit split_by_bins(std::span<const BuildReference> references, const RangeSummary& all,
                          const LeafKinds& kinds) {
    const Binning binning(all);
    Bins bins(binning.bins);
    for_chunks<Bins>(
        references,
        [&](Bins& some, std::span<const BuildReference> part) { fill(part, binning, some); },
        [&](Bins& sum, const Bins& part) {
            for (int axis = 0; axis < 3; ++axis) {
                for (int b = 0; b < binning.bins; ++b) sum.of(axis)[b].include(part.of(axis)[b]);
            }
        },
        bins);
    ObjectSplit best;
    const SideCost cost{kinds, all.kind()};
    for (int axis = 0; axis < 3; ++axis) {
        if (binning.scale[axis] == 0) continue;
        best_of_bins(bins.of(axis), binning.bins, axis, cost, best);
    }
    return best;
}

bool before(const BuildReference& a, const BuildReference& b, int axis) {
    const float ca = a.center2(axis);
    const float cb = b.center2(axis);
    return ca != cb ? ca < cb : a.id < b.id;
}

/// The order of a few references along an axis; stable. Compares all pairs without branches, as
/// comparisons are unpredictable.
void sort_places(std::span<const BuildReference> references, int axis, std::uint8_t* places) {
    float center[kSweepSize];
    std::uint32_t rank[kSweepSize];
    const std::size_t size = references.size();
    for (std::size_t i = 0; i < size; ++i) {
        center[i] = references[i].center2(axis);
        std::uint32_t before = 0;
        for (std::size_t k = 0; k < i; ++k) {
            const std::uint32_t later = center[i] < center[k];
            rank[k] += later;
            before += 1 - later;
        }
        rank[i] = before;
    }
    for (std::size_t i = 0; i < size; ++i) places[rank[i]] = static_cast<std::uint8_t>(i);
}

/// The best split of a few references in the order of their centers.
ObjectSplit sweep(std::span<const BuildReference> references, const RangeSummary& all,
                  const LeafKinds& kinds) {
    ObjectSplit best;
    const SideCost cost{kinds, all.kind()};
    const std::size_t size = references.size();
    for (int axis = 0; axis < 3; ++axis) {
        if (!(all.centers.hi[axis] > all.centers.lo[axis])) continue;
        std::uint8_t places[kSweepSize];
        sort_places(references, axis, places);
        float right_cost[kSweepSize];
        Box4 right_box[kSweepSize];
        Bin right;
        for (std::size_t i = size - 1; i > 0; --i) {
            right.box.include(Box4(references[places[i]]));
            ++right.count[references[places[i]].kind];
            right_box[i] = right.box;
            right_cost[i] = cost(right.box, right.count);
        }
        Bin left;
        for (std::size_t i = 0; i + 1 < size; ++i) {
            left.box.include(Box4(references[places[i]]));
            ++left.count[references[places[i]].kind];
            const float sum = cost(left.box, left.count) + right_cost[i + 1];
            if (sum < best.cost) {
                best = {sum, axis, static_cast<int>(i), left.box, right_box[i + 1]};
            }
        }
    }
    return best;
}

/// Precondition: `out` is empty.
void summarize_some(std::span<const BuildReference> references, RangeSummary& out) {
    // Separate from the counts, so that the boxes stay in registers.
    Box4 box, centers;
    KindCounts count{};
    for (const BuildReference& r : references) {
        const Box4 b(r);
        box.include(b);
        centers.include_point(b.center2());
        ++count[r.kind];
    }
    out.box = box;
    out.centers = centers;
    out.count = count;
}

void summarize_both(std::span<const BuildReference> references, std::uint32_t middle,
                    RangeSummary& left, RangeSummary& right) {
    summarize_some(references.first(middle), left);
    summarize_some(references.subspan(middle), right);
}

/// Moves the references with is_left(r) to the front. Swaps every reference, if need be with
/// itself, without branches: the side is unpredictable.
template <class IsLeft>
std::uint32_t partition(std::span<BuildReference> references, const IsLeft& is_left,
                        RangeSummary& left, RangeSummary& right) {
    std::uint32_t middle = 0;
    for (BuildReference& place : references) {
        const BuildReference r = place;
        place = references[middle];
        references[middle] = r;
        middle += static_cast<std::uint32_t>(is_left(r));
    }
    summarize_both(references, middle, left, right);
    return middle;
}

}  // namespace

RangeSummary summarize(std::span<const BuildReference> references) {
    RangeSummary all;
    for_chunks<RangeSummary>(
        references,
        [](RangeSummary& some, std::span<const BuildReference> part) {
            summarize_some(part, some);
        },
        [](RangeSummary& sum, const RangeSummary& part) { sum.include(part); }, all);
    return all;
}

ObjectSplit best_object_split(std::span<const BuildReference> references, const RangeSummary& all,
                              const LeafKinds& kinds) {
    return references.size() <= kSweepSize ? sweep(references, all, kinds)
                                           : split_by_bins(references, all, kinds);
}

std::uint32_t divide(std::span<BuildReference> references, const RangeSummary& all,
                     const ObjectSplit& split, RangeSummary& left, RangeSummary& right) {
    if (references.size() <= kSweepSize) {
        std::uint8_t places[kSweepSize];
        sort_places(references, split.axis, places);
        std::array<BuildReference, kSweepSize> before;
        std::copy(references.begin(), references.end(), before.begin());
        for (std::size_t i = 0; i < references.size(); ++i) references[i] = before[places[i]];
        const auto middle = static_cast<std::uint32_t>(split.last_left) + 1;
        summarize_both(references, middle, left, right);
        return middle;
    }
    const Binning binning(all);
    const auto is_left = [&](const BuildReference& r) {
        return binning.bin_along(r, split.axis) <= split.last_left;
    };
    return partition(references, is_left, left, right);
}

std::uint32_t divide_evenly(std::span<BuildReference> references, const RangeSummary& all,
                            RangeSummary& left, RangeSummary& right) {
    if (all.kind() == kLeafKinds) {
        std::uint32_t lowest = 0;
        while (all.count[lowest] == 0) ++lowest;
        const auto is_left = [&](const BuildReference& r) { return r.kind == lowest; };
        return partition(references, is_left, left, right);
    }
    int axis = 0;
    for (int k = 1; k < 3; ++k) {
        const auto extent = [&](int a) { return all.centers.hi[a] - all.centers.lo[a]; };
        if (extent(k) > extent(axis)) axis = k;
    }
    const auto middle = static_cast<std::uint32_t>(references.size() / 2);
    std::nth_element(
        references.begin(), references.begin() + middle, references.end(),
        [axis](const BuildReference& a, const BuildReference& b) { return before(a, b, axis); });
    summarize_both(references, middle, left, right);
    return middle;
}

}  // namespace alhazen
