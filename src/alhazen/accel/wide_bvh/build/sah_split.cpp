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
constexpr std::size_t kTwoSets = 128;         // from this size on, two sets of bins are used
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

/// Whether the bin of a reference along the axis of a split is on its left.
class LeftOf {
  public:
    LeftOf(const Binning& binning, const ObjectSplit& split)
        : axis_(split.axis),
          lo_(binning.lo[split.axis]),
          scale_(binning.scale[split.axis]),
          limit_(static_cast<float>(split.last_left + 1)) {}
    bool operator()(const BuildReference& r) const {
        return (r.center2(axis_) - lo_) * scale_ < limit_;
    }

  private:
    int axis_;
    float lo_, scale_, limit_;
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

    [[nodiscard]] float operator()(const Box4& box, const KindCounts& count) const {
        return box.weight() * blocks_cost(count, kinds);
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

/// A box for each axis. A lane stands for an axis; the fourth one repeats the third.
struct AxisBoxes {
    Box4 of[3];

    /// As Box4::weight; of an empty box as of a point.
    [[nodiscard]] Float4 weights() const {
        const Float4 a = size(of[0]), b = size(of[1]), c = size(of[2]);
        const Float4 low = __builtin_shufflevector(a, b, 0, 4, 1, 5);
        const Float4 high = __builtin_shufflevector(a, b, 2, 6, 3, 7);
        const Float4 x = __builtin_shufflevector(low, c, 0, 1, 4, 4);
        const Float4 y = __builtin_shufflevector(low, c, 2, 3, 5, 5);
        const Float4 z = __builtin_shufflevector(high, c, 0, 1, 6, 6);
        return x * y + y * z + z * x + 1e-6f * (x + y + z) + 1e-12f;
    }

  private:
    static Float4 size(const Box4& box) { return greater(box.hi - box.lo, Float4{}); }
};

/// `mask` ? a : b, lane by lane; a mask has all bits of a lane or none.
Float4 chosen(Int4 mask, Float4 a, Float4 b) {
    Int4 x, y;
    std::memcpy(&x, &a, sizeof(x));
    std::memcpy(&y, &b, sizeof(y));
    const Int4 bits = (mask & x) | (~mask & y);
    Float4 result;
    std::memcpy(&result, &bits, sizeof(result));
    return result;
}

/// The cheapest split of each axis.
struct AxisSplits {
    static constexpr float kInf = std::numeric_limits<float>::infinity();
    Float4 cost{kInf, kInf, kInf, kInf};
    Int4 last_left{};

    void offer(Float4 sum, Int4 valid, int last) {
        const Int4 better = valid & (sum < cost);
        cost = chosen(better, sum, cost);
        last_left = (better & last) | (~better & last_left);
    }
    /// The cheapest one of all, without boxes.
    [[nodiscard]] ObjectSplit best() const {
        ObjectSplit split;
        for (int axis = 0; axis < 3; ++axis) {
            if (!(cost[axis] < split.cost)) continue;
            split.cost = cost[axis];
            split.axis = axis;
            split.last_left = last_left[axis];
        }
        return split;
    }
};

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
    const Binning binning = all;  // seen not to change
    const auto add = [&](const BuildReference& r, PlainBins& to) {
        const Box4 box(r);
        to.include(box, binning.bin(box.center2()));
    };
    const BuildReference* r = references.data();
    const BuildReference* const end = r + references.size();
    if (references.size() >= kTwoSets) {
        // Neighbors often fall into one bin, and would wait for each other.
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

bool before(const BuildReference& a, const BuildReference& b, int axis) {
    const float ca = a.center2(axis);
    const float cb = b.center2(axis);
    return ca != cb ? ca < cb : a.id < b.id;
}

/// The order of a few references along each axis.
using Places = std::array<std::array<std::uint8_t, kSweepSize>, 3>;

/// Stable. Compares all pairs without branches, as comparisons are unpredictable.
void sort_places(const BuildReference* references, std::size_t size, Places& places) {
    Float4 center[kSweepSize];
    Int4 rank[kSweepSize];
    for (std::size_t i = 0; i < size; ++i) {
        const Float4 here = Box4(references[i]).center2();
        center[i] = here;
        Int4 sooner = Int4{} + static_cast<int>(i);
        for (std::size_t k = 0; k < i; ++k) {
            const Int4 later = here < center[k];  // -1 where true
            rank[k] -= later;
            sooner += later;
        }
        rank[i] = sooner;
    }
    for (std::size_t i = 0; i < size; ++i) {
        const auto number = static_cast<std::uint8_t>(i);
        places[0][static_cast<std::size_t>(rank[i][0])] = number;
        places[1][static_cast<std::size_t>(rank[i][1])] = number;
        places[2][static_cast<std::size_t>(rank[i][2])] = number;
    }
}

/// The best split of a few references of several kinds.
ObjectSplit sweep_mixed(const BuildReference* references, std::size_t size, const Places& places,
                        const RangeSummary& all, const LeafKinds& kinds) {
    ObjectSplit best;
    const SideCost cost{kinds};
    for (int axis = 0; axis < 3; ++axis) {
        if (!(all.centers.hi[axis] > all.centers.lo[axis])) continue;
        const auto& order = places[static_cast<std::size_t>(axis)];
        float right_cost[kSweepSize];
        Box4 right_box[kSweepSize];
        Bin right;
        for (std::size_t i = size - 1; i > 0; --i) {
            right.box.include(Box4(references[order[i]]));
            ++right.count[references[order[i]].kind];
            right_box[i] = right.box;
            right_cost[i] = cost(right.box, right.count);
        }
        Bin left;
        for (std::size_t i = 0; i + 1 < size; ++i) {
            left.box.include(Box4(references[order[i]]));
            ++left.count[references[order[i]].kind];
            const float sum = cost(left.box, left.count) + right_cost[i + 1];
            if (sum < best.cost) {
                best = {sum, axis, static_cast<int>(i), left.box, right_box[i + 1], {}};
            }
        }
    }
    return best;
}

/// The best split of a few references of one kind: all axes at once, in lanes.
ObjectSplit sweep_plain(const BuildReference* references, std::size_t size, const Places& places,
                        const RangeSummary& all, const LeafKind& kind) {
    const auto include = [&](AxisBoxes& boxes, std::size_t i) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            boxes.of[axis].include(Box4(references[places[axis][i]]));
        }
    };
    const auto cost = [&](const AxisBoxes& boxes, std::size_t number) {
        const auto blocks = static_cast<float>(kind.blocks(static_cast<std::uint32_t>(number)));
        return boxes.weights() * kind.cost * blocks;
    };
    Float4 right_cost[kSweepSize];
    AxisBoxes right;
    for (std::size_t i = size - 1; i > 0; --i) {
        include(right, i);
        right_cost[i] = cost(right, size - i);
    }
    const Int4 wide = all.centers.hi > all.centers.lo;
    AxisSplits splits;
    AxisBoxes left;
    for (std::size_t i = 0; i + 1 < size; ++i) {
        include(left, i);
        splits.offer(cost(left, i + 1) + right_cost[i + 1], wide, static_cast<int>(i));
    }
    ObjectSplit best = splits.best();
    if (best.axis < 0) return best;
    const auto& order = places[static_cast<std::size_t>(best.axis)];
    const auto middle = static_cast<std::size_t>(best.last_left) + 1;
    for (std::size_t i = 0; i < middle; ++i) best.left.include(Box4(references[order[i]]));
    for (std::size_t i = middle; i < size; ++i) best.right.include(Box4(references[order[i]]));
    return best;
}

/// The best split of a few references in the order of their centers.
ObjectSplit sweep(std::span<const BuildReference> references, const RangeSummary& all,
                  const LeafKinds& kinds) {
    Places places;
    sort_places(references.data(), references.size(), places);
    const std::uint32_t only = all.kind();
    ObjectSplit best =
        only == kLeafKinds
            ? sweep_mixed(references.data(), references.size(), places, all, kinds)
            : sweep_plain(references.data(), references.size(), places, all, kinds[only]);
    if (best.axis >= 0) best.places = places[static_cast<std::size_t>(best.axis)];
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

Box4 box_of_centers(std::span<const BuildReference> references) {
    Box4 centers;
    for (const BuildReference& r : references) centers.include_point(Box4(r).center2());
    return centers;
}

/// The same where the sides and their boxes are known from the split.
void summarize_sides(std::span<const BuildReference> references, const RangeSummary& all,
                     const ObjectSplit& split, std::uint32_t middle, RangeSummary& left,
                     RangeSummary& right) {
    const std::uint32_t only = all.kind();
    if (only == kLeafKinds) return summarize_both(references, middle, left, right);
    left.box = split.left;
    right.box = split.right;
    left.count[only] = middle;
    right.count[only] = static_cast<std::uint32_t>(references.size()) - middle;
    left.centers = box_of_centers(references.first(middle));
    right.centers = box_of_centers(references.subspan(middle));
}

/// Moves the references with is_left(r) to the front. Swaps every reference, if need be with
/// itself, without branches: the side is unpredictable. Returns their number.
template <class IsLeft>
std::uint32_t partition(std::span<BuildReference> references, const IsLeft& is_left) {
    BuildReference* middle = references.data();
    for (BuildReference& place : references) {
        const Box4 here(place), there(*middle);
        BuildReference* const to = middle;
        middle += static_cast<std::ptrdiff_t>(is_left(place));
        std::memcpy(place.lo, &there.lo, sizeof(there.lo));
        std::memcpy(place.hi, &there.hi, sizeof(there.hi));
        std::memcpy(to->lo, &here.lo, sizeof(here.lo));
        std::memcpy(to->hi, &here.hi, sizeof(here.hi));
    }
    return static_cast<std::uint32_t>(middle - references.data());
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
    std::uint32_t middle = 0;
    if (references.size() <= kSweepSize) {
        std::array<BuildReference, kSweepSize> before;
        std::copy(references.begin(), references.end(), before.begin());
        for (std::size_t i = 0; i < references.size(); ++i) references[i] = before[split.places[i]];
        middle = static_cast<std::uint32_t>(split.last_left) + 1;
    } else {
        middle = partition(references, LeftOf(Binning(all), split));
    }
    summarize_sides(references, all, split, middle, left, right);
    return middle;
}

std::uint32_t divide_evenly(std::span<BuildReference> references, const RangeSummary& all,
                            RangeSummary& left, RangeSummary& right) {
    if (all.kind() == kLeafKinds) {
        std::uint32_t lowest = 0;
        while (all.count[lowest] == 0) ++lowest;
        const std::uint32_t middle =
            partition(references, [&](const BuildReference& r) { return r.kind == lowest; });
        summarize_both(references, middle, left, right);
        return middle;
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
