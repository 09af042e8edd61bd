#include <algorithm>
#include <cstddef>
#include <new>

#include "alhazen/accel/wide_bvh/build/binning.h"
#include "alhazen/accel/wide_bvh/build/reference_chunks.h"
#include "alhazen/accel/wide_bvh/build/sah_split.h"
#include "alhazen/accel/wide_bvh/build/split_kernels.h"

namespace alhazen {
namespace {

/// Only the bins in use are constructed.
class Bins {
  public:
    explicit Bins(int count) {
        for (int axis = 0; axis < 3; ++axis) {
            for (int b = 0; b < count; ++b) new (&of(axis)[b]) KindBox;
        }
    }
    [[nodiscard]] KindBox* of(int axis) {
        return reinterpret_cast<KindBox*>(room_) + axis * kMaxBins;
    }
    [[nodiscard]] const KindBox* of(int axis) const {
        return reinterpret_cast<const KindBox*>(room_) + axis * kMaxBins;
    }

  private:
    alignas(KindBox) std::byte room_[3 * kMaxBins * sizeof(KindBox)];
};

void fill(std::span<const BuildReference> references, const Binning& binning, Bins& bins) {
    for (const BuildReference& r : references) {
        const Box4 box(r);
        const Int4 place = binning.bin(box.center2());
        // Unrolled by hand: constant lanes of `place` stay in registers.
        const auto add = [&](int axis, int b) {
            KindBox& bin = bins.of(axis)[b];
            bin.box.include(box);
            ++bin.count[r.kind];
        };
        add(0, place[0]);
        add(1, place[1]);
        add(2, place[2]);
    }
}

void best_of_bins(const KindBox* bins, int count, int axis, const SideCost& cost,
                  ObjectSplit& best) {
    float right_cost[kMaxBins];
    Box4 right_box[kMaxBins];
    KindBox right;
    for (int b = count - 1; b > 0; --b) {
        right.include(bins[b]);
        right_box[b] = right.box;
        right_cost[b] = total(right.count) == 0 ? 0 : cost(right.box, right.count);
    }
    const std::uint32_t all = total(right.count) + total(bins[0].count);
    KindBox left;
    for (int b = 0; b + 1 < count; ++b) {
        left.include(bins[b]);
        const std::uint32_t size = total(left.count);
        if (size == 0) continue;
        if (size == all) break;
        const float sum = cost(left.box, left.count) + right_cost[b + 1];
        if (sum < best.cost) best = {sum, axis, b, left.box, right_box[b + 1], {}};
    }
}

/// For primitives of several kinds.
ObjectSplit split_mixed_by_bins(std::span<const BuildReference> references, const Binning& binning,
                                const LeafKinds& kinds) {
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
    const SideCost cost{kinds};
    for (int axis = 0; axis < 3; ++axis) {
        if (binning.scale[axis] == 0) continue;
        best_of_bins(bins.of(axis), binning.bins, axis, cost, best);
    }
    return best;
}

}  // namespace

ObjectSplit split_by_bins(std::span<const BuildReference> references, const RangeSummary& all,
                          const LeafKinds& kinds) {
    const Binning binning(all);
    const std::uint32_t only = all.kind();
    if (only == kLeafKinds) return split_mixed_by_bins(references, binning, kinds);
    const SplitKernels& kernels = split_kernels();
    PlainBins bins;
    if (references.size() <= 2 * kReferenceChunk) {
        kernels.fill(references.data(), references.size(), binning, bins);
    } else {
        kernels.fill(references.data(), 0, binning, bins);
        for_chunks<PlainBins>(
            references,
            [&](PlainBins& some, std::span<const BuildReference> part) {
                kernels.fill(part.data(), part.size(), binning, some);
            },
            [&](PlainBins& sum, const PlainBins& part) { kernels.add(sum, part, binning.bins); },
            bins);
    }
    return kernels.best(bins, binning.bins, static_cast<int>(references.size()), kinds[only]);
}

std::uint32_t partition_by_bins(std::span<BuildReference> references, const RangeSummary& all,
                                const ObjectSplit& split, Box4& left_centers,
                                Box4& right_centers) {
    return split_kernels().divide(references.data(), references.size(), Binning(all), split,
                                  left_centers, right_centers);
}

}  // namespace alhazen
