#include <algorithm>
#include <cstddef>
#include <new>

#include "alhazen/accel/wide_bvh/build/axis_splits.h"
#include "alhazen/accel/wide_bvh/build/reference_chunks.h"
#include "alhazen/accel/wide_bvh/build/sah_split.h"

namespace alhazen {
namespace {

constexpr int kMaxBins = 32;
constexpr std::size_t kTwoSets = 128;  // from this size on, two sets of bins are used

/// Sets the fourth lane to 0.
Float4 first_three(Float4 v) {
    Int4 bits;
    std::memcpy(&bits, &v, sizeof(bits));
    bits &= Int4{-1, -1, -1, 0};
    std::memcpy(&v, &bits, sizeof(v));
    return v;
}

/// Sets the lanes of a mask to what is no number.
Float4 masked(Float4 v, Int4 mask) {
    Int4 bits;
    std::memcpy(&bits, &v, sizeof(bits));
    bits |= mask;
    std::memcpy(&v, &bits, sizeof(v));
    return v;
}

/// The bins of a center along all axes; counting and dividing use the same function.
struct Binning {
    int bins;
    Float4 lo, scale, most;

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
        most = Float4{1, 1, 1, 1} * static_cast<float>(bins - 1);
    }
    [[nodiscard]] Int4 bin(Float4 center2) const {
        const Float4 place = (first_three(center2) - lo) * scale;
        return __builtin_convertvector(lesser(place, most), Int4);
    }
};

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

/// The bins of primitives of one kind: a row of boxes for each axis, and one of their numbers. Only
/// bins in use are made. All parts of a bin lie at the same offset in their rows.
class PlainBins {
  public:
    explicit PlainBins(int bins) {
        for (std::uint32_t at = 0; at < kBytes * static_cast<std::uint32_t>(bins); at += kBytes) {
            for (std::size_t axis = 0; axis < 3; ++axis) new (rows_[axis] + at) Box4;
            *reinterpret_cast<Int4*>(rows_[3] + at) = Int4{};
        }
    }
    [[nodiscard]] const Box4& box(std::size_t axis, int bin) const {
        return *reinterpret_cast<const Box4*>(rows_[axis] + kBytes * static_cast<unsigned>(bin));
    }
    /// Lane: axis.
    [[nodiscard]] const Int4& count(int bin) const {
        return *reinterpret_cast<const Int4*>(rows_[3] + kBytes * static_cast<unsigned>(bin));
    }
    void include(const Box4& b, Int4 bins) {
        const Int4 at = bins * static_cast<int>(kBytes);
        add<0>(b, static_cast<std::uint32_t>(at[0]));
        add<1>(b, static_cast<std::uint32_t>(at[1]));
        add<2>(b, static_cast<std::uint32_t>(at[2]));
    }
    void include(const PlainBins& other, int bins) {
        for (std::uint32_t at = 0; at < kBytes * static_cast<std::uint32_t>(bins); at += kBytes) {
            for (std::size_t axis = 0; axis < 3; ++axis) {
                reinterpret_cast<Box4*>(rows_[axis] + at)
                    ->include(*reinterpret_cast<const Box4*>(other.rows_[axis] + at));
            }
            *reinterpret_cast<Int4*>(rows_[3] + at) +=
                *reinterpret_cast<const Int4*>(other.rows_[3] + at);
        }
    }

  private:
    static constexpr std::uint32_t kBytes = sizeof(Box4);

    template <std::size_t Axis>
    void add(const Box4& b, std::uint32_t at) {
        reinterpret_cast<Box4*>(rows_[Axis] + at)->include(b);
        ++reinterpret_cast<std::int32_t*>(rows_[3] + at)[Axis];
    }

    alignas(Box4) std::byte rows_[4][kMaxBins * kBytes];
};

void fill(std::span<const BuildReference> references, const Binning& all, PlainBins& bins) {
    const Binning binning = all;  // a local copy, known to be constant
    const auto add = [&](const BuildReference& r, PlainBins& to) {
        const Box4 box(r);
        to.include(box, binning.bin(box.center2()));
    };
    const BuildReference* r = references.data();
    const BuildReference* const end = r + references.size();
    if (references.size() >= kTwoSets) {
        // Neighbors often fall into one bin; a second set avoids waiting for the first update.
        PlainBins others(binning.bins);
        for (; end - r >= 2; r += 2) {
            add(r[0], bins);
            add(r[1], others);
        }
        bins.include(others, binning.bins);
    }
    for (; r != end; ++r) add(*r, bins);
}

/// For primitives of one kind: all axes at once, in lanes.
ObjectSplit best_of_bins(const PlainBins& bins, int count, int size, const LeafKind& kind) {
    const auto cost = [&](const AxisBoxes& boxes, Int4 numbers) {
        const Int4 blocks = (numbers + static_cast<int>(kind.width() - 1)) >> kind.width_log2;
        return boxes.weights() * kind.cost * __builtin_convertvector(blocks, Float4);
    };
    const auto include = [&](AxisBoxes& boxes, int b) {
        for (std::size_t axis = 0; axis < 3; ++axis) boxes.of[axis].include(bins.box(axis, b));
    };
    Float4 right_cost[kMaxBins];
    AxisBoxes right;
    Int4 number{};
    for (int b = count - 1; b > 0; --b) {
        include(right, b);
        number += bins.count(b);
        right_cost[b] = cost(right, number);
    }
    AxisSplits splits;
    AxisBoxes left;
    number = Int4{};
    for (int b = 0; b + 1 < count; ++b) {
        include(left, b);
        number += bins.count(b);
        splits.offer(cost(left, number) + right_cost[b + 1], (number > 0) & (number < size), b);
    }
    ObjectSplit best = splits.best();
    if (best.axis < 0) return best;
    const auto axis = static_cast<std::size_t>(best.axis);
    for (int b = 0; b <= best.last_left; ++b) best.left.include(bins.box(axis, b));
    for (int b = best.last_left + 1; b < count; ++b) best.right.include(bins.box(axis, b));
    return best;
}

}  // namespace

ObjectSplit split_by_bins(std::span<const BuildReference> references, const RangeSummary& all,
                          const LeafKinds& kinds) {
    const Binning binning(all);
    const std::uint32_t only = all.kind();
    if (only == kLeafKinds) return split_mixed_by_bins(references, binning, kinds);
    PlainBins bins(binning.bins);
    for_chunks<PlainBins>(
        references,
        [&](PlainBins& some, std::span<const BuildReference> part) { fill(part, binning, some); },
        [&](PlainBins& sum, const PlainBins& part) { sum.include(part, binning.bins); }, bins);
    return best_of_bins(bins, binning.bins, static_cast<int>(references.size()), kinds[only]);
}

/// As `partition`. Centers of the other side are masked: their lanes are no numbers, which minima and
/// maxima skip.
std::uint32_t partition_by_bins(std::span<BuildReference> references, const RangeSummary& all,
                                const ObjectSplit& split, Box4& left_centers,
                                Box4& right_centers) {
    const Binning binning(all);
    const int axis = split.axis;
    const Float4 lo = Float4{} + binning.lo[axis], scale = Float4{} + binning.scale[axis];
    const Float4 limit = Float4{} + static_cast<float>(split.last_left + 1);
    Box4 left, right;  // local, in registers
    BuildReference* middle = references.data();
    for (BuildReference& place : references) {
        const Box4 here(place), there(*middle);
        const Float4 along = Float4{} + place.center2(axis);
        const Int4 is_left = (along - lo) * scale < limit;  // -1 in each lane where true
        BuildReference* const to = middle;
        middle -= is_left[0];
        std::memcpy(place.lo, &there.lo, sizeof(there.lo));
        std::memcpy(place.hi, &there.hi, sizeof(there.hi));
        std::memcpy(to->lo, &here.lo, sizeof(here.lo));
        std::memcpy(to->hi, &here.hi, sizeof(here.hi));
        const Float4 center2 = here.center2();
        left.include_point(masked(center2, ~is_left));
        right.include_point(masked(center2, is_left));
    }
    left_centers = left;
    right_centers = right;
    return static_cast<std::uint32_t>(middle - references.data());
}

}  // namespace alhazen
