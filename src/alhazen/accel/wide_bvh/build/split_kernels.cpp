#include "alhazen/accel/wide_bvh/build/split_kernels.h"

#include "alhazen/simd/dispatch.h"

// Compiles the rest of this file once per target.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "alhazen/accel/wide_bvh/build/split_kernels.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// After foreach_target.h.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {
namespace {

#if HWY_ARCH_X86 && HWY_TARGET <= HWY_AVX2

using Float8 = float __attribute__((vector_size(32)));
using Int8 = std::int32_t __attribute__((vector_size(32)));

/// The bits of a reference.
struct Whole {
    Int8 v;

    HWY_INLINE explicit Whole(const BuildReference& r) { std::memcpy(&v, &r, sizeof(v)); }
    HWY_INLINE void store(BuildReference& r) const { std::memcpy(static_cast<void*>(&r), &v, sizeof(v)); }
    [[nodiscard]] HWY_INLINE Float4 center2() const {
        Float8 f;
        std::memcpy(&f, &v, sizeof(f));
        return __builtin_shufflevector(f, f, 0, 1, 2, 3) +
               __builtin_shufflevector(f, f, 4, 5, 6, 7);
    }
};

/// A box, its lower sides negated. Lanes 3 and 7 are unused.
struct Sides {
    Float8 v;

    Sides() = default;
    HWY_INLINE explicit Sides(const BuildReference& r) {
        constexpr std::int32_t kSign = INT32_MIN;
        Int8 bits;
        std::memcpy(&bits, &r, sizeof(bits));
        bits ^= Int8{kSign, kSign, kSign, 0, 0, 0, 0, 0};
        std::memcpy(&v, &bits, sizeof(v));
    }
    HWY_INLINE void clear() { v = Float8{} - std::numeric_limits<float>::infinity(); }
    HWY_INLINE void include(const Sides& b) { v = _mm256_max_ps(b.v, v); }
    [[nodiscard]] HWY_INLINE Float4 less_lo() const {
        return __builtin_shufflevector(v, v, 0, 1, 2, 3);
    }
    [[nodiscard]] HWY_INLINE Float4 hi() const { return __builtin_shufflevector(v, v, 4, 5, 6, 7); }
};

#else

struct Whole {
    Box4 box;

    HWY_INLINE explicit Whole(const BuildReference& r) : box(r) {}
    HWY_INLINE void store(BuildReference& r) const {
        std::memcpy(r.lo, &box.lo, sizeof(box.lo));
        std::memcpy(r.hi, &box.hi, sizeof(box.hi));
    }
    [[nodiscard]] HWY_INLINE Float4 center2() const { return box.center2(); }
};

struct Sides {
    Float4 low, high;

    Sides() = default;
    HWY_INLINE explicit Sides(const BuildReference& r) {
        const Box4 box(r);
        low = -box.lo;
        high = box.hi;
    }
    HWY_INLINE void clear() { low = high = Float4{} - std::numeric_limits<float>::infinity(); }
    HWY_INLINE void include(const Sides& b) {
        low = greater(b.low, low);
        high = greater(b.high, high);
    }
    [[nodiscard]] HWY_INLINE Float4 less_lo() const { return low; }
    [[nodiscard]] HWY_INLINE Float4 hi() const { return high; }
};

#endif
static_assert(sizeof(Sides) == PlainBins::kBytes);

HWY_INLINE Float4 in_all_lanes(float v) {
    return Float4{v, v, v, v};
}

HWY_INLINE Box4 box_of_sides(const Sides& sides) {
    Box4 box;
    box.lo = -sides.less_lo();
    box.hi = sides.hi();
    return box;
}

/// A box for each axis. A lane of the weights stands for an axis; the fourth one repeats the third.
struct AxisSides {
    Sides of[3];

    HWY_INLINE AxisSides() {
        for (Sides& sides : of) sides.clear();
    }
    /// As Box4::weight; an empty box has the weight of a point.
    [[nodiscard]] HWY_INLINE Float4 weights() const {
        const Float4 a = extent(of[0]), b = extent(of[1]), c = extent(of[2]);
        const Float4 low = __builtin_shufflevector(a, b, 0, 4, 1, 5);
        const Float4 high = __builtin_shufflevector(a, b, 2, 6, 3, 7);
        const Float4 x = __builtin_shufflevector(low, c, 0, 1, 4, 4);
        const Float4 y = __builtin_shufflevector(low, c, 2, 3, 5, 5);
        const Float4 z = __builtin_shufflevector(high, c, 0, 1, 6, 6);
        return x * y + y * z + z * x + 1e-6f * (x + y + z) + 1e-12f;
    }

  private:
    static HWY_INLINE Float4 extent(const Sides& sides) {
        return greater(sides.hi() + sides.less_lo(), Float4{});
    }
};

HWY_INLINE Sides& sides_at(PlainBins& bins, std::size_t axis, std::size_t at) {
    return *reinterpret_cast<Sides*>(bins.rows[axis] + at);
}
HWY_INLINE const Sides& sides_at(const PlainBins& bins, std::size_t axis, std::size_t at) {
    return *reinterpret_cast<const Sides*>(bins.rows[axis] + at);
}
/// Lane: axis.
HWY_INLINE Int4& count_at(PlainBins& bins, std::size_t at) {
    return *reinterpret_cast<Int4*>(bins.rows[3] + at);
}
HWY_INLINE const Int4& count_at(const PlainBins& bins, std::size_t at) {
    return *reinterpret_cast<const Int4*>(bins.rows[3] + at);
}

HWY_INLINE void clear(PlainBins& bins, int count) {
    for (std::size_t at = 0; at < PlainBins::kBytes * static_cast<std::size_t>(count);
         at += PlainBins::kBytes) {
        for (std::size_t axis = 0; axis < 3; ++axis) sides_at(bins, axis, at).clear();
        count_at(bins, at) = Int4{};
    }
}

void add_bins(PlainBins& sum, const PlainBins& bins, int count) {
    for (std::size_t at = 0; at < PlainBins::kBytes * static_cast<std::size_t>(count);
         at += PlainBins::kBytes) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            sides_at(sum, axis, at).include(sides_at(bins, axis, at));
        }
        count_at(sum, at) += count_at(bins, at);
    }
}

template <std::size_t Axis>
HWY_INLINE void add_to_axis(PlainBins& bins, const Sides& sides, std::uint32_t at) {
    sides_at(bins, Axis, at).include(sides);
    ++reinterpret_cast<std::int32_t*>(bins.rows[3] + at)[Axis];
}
HWY_INLINE void add_reference(PlainBins& bins, const BuildReference& r, const Binning& binning) {
    const Int4 at = binning.bin(Box4(r).center2()) * static_cast<int>(PlainBins::kBytes);
    const Sides sides(r);
    add_to_axis<0>(bins, sides, static_cast<std::uint32_t>(at[0]));
    add_to_axis<1>(bins, sides, static_cast<std::uint32_t>(at[1]));
    add_to_axis<2>(bins, sides, static_cast<std::uint32_t>(at[2]));
}

/// From these sizes on, more sets of bins are used in turn.
constexpr std::size_t kTwoSets = 128, kFourSets = 1024;

/// Fills sets in turn with as many references as there are; returns the rest. Neighbors often fall
/// into one bin; another set avoids waiting for the last update.
template <std::size_t Others>
HWY_INLINE const BuildReference* fill_in_turn(const BuildReference* r, const BuildReference* end,
                                              const Binning& binning, PlainBins& bins) {
    PlainBins others[Others];
    for (PlainBins& other : others) clear(other, binning.bins);
    for (; end - r > static_cast<std::ptrdiff_t>(Others); r += Others + 1) {
        add_reference(bins, r[0], binning);
        add_reference(others[0], r[1], binning);
        if constexpr (Others == 3) {
            add_reference(others[1], r[2], binning);
            add_reference(others[2], r[3], binning);
        }
    }
    for (const PlainBins& other : others) add_bins(bins, other, binning.bins);
    return r;
}

void fill_bins(const BuildReference* r, std::size_t size, const Binning& all, PlainBins& bins) {
    const Binning binning = all;  // a local copy, known to be constant
    const BuildReference* const end = r + size;
    clear(bins, binning.bins);
    if (size >= kFourSets) {
        r = fill_in_turn<3>(r, end, binning, bins);
    } else if (size >= kTwoSets) {
        r = fill_in_turn<1>(r, end, binning, bins);
    }
    for (; r != end; ++r) add_reference(bins, *r, binning);
}

/// The costs of a side of each axis.
HWY_INLINE Float4 costs_of(const AxisSides& boxes, Int4 numbers, const LeafKind& kind) {
    const Int4 blocks = (numbers + static_cast<int>(kind.width() - 1)) >> kind.width_log2;
    return boxes.weights() * kind.cost * __builtin_convertvector(blocks, Float4);
}
HWY_INLINE void include_bin(AxisSides& boxes, const PlainBins& bins, std::size_t at) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        boxes.of[axis].include(sides_at(bins, axis, at));
    }
}

/// All axes at once, in lanes.
ObjectSplit best_of_plain_bins(const PlainBins& bins, int count, int size, const LeafKind& kind) {
    constexpr std::size_t kBytes = PlainBins::kBytes;
    const auto last = static_cast<std::size_t>(count) - 1;
    Float4 right_cost[kMaxBins];
    AxisSides right;
    Int4 number{};
    for (std::size_t b = last; b > 0; --b) {
        include_bin(right, bins, b * kBytes);
        number += count_at(bins, b * kBytes);
        right_cost[b] = costs_of(right, number, kind);
    }
    AxisSplits splits;
    AxisSides left;
    number = Int4{};
    for (std::size_t b = 0; b < last; ++b) {
        include_bin(left, bins, b * kBytes);
        number += count_at(bins, b * kBytes);
        splits.offer(costs_of(left, number, kind) + right_cost[b + 1],
                     (number > 0) & (number < size), static_cast<int>(b));
    }
    ObjectSplit best = splits.best();
    if (best.axis < 0) return best;
    const auto axis = static_cast<std::size_t>(best.axis);
    const auto middle = static_cast<std::size_t>(best.last_left) + 1;
    Sides of_left, of_right;
    of_left.clear();
    of_right.clear();
    for (std::size_t b = 0; b < middle; ++b) of_left.include(sides_at(bins, axis, b * kBytes));
    for (std::size_t b = middle; b <= last; ++b) of_right.include(sides_at(bins, axis, b * kBytes));
    best.left = box_of_sides(of_left);
    best.right = box_of_sides(of_right);
    return best;
}

/// As `partition`. Centers of the other side count as infinite ones.
std::uint32_t divide_by_bins(BuildReference* references, std::size_t size, const Binning& binning,
                             const ObjectSplit& split, Box4& left_centers, Box4& right_centers) {
    const int axis = split.axis;
    const Float4 lo = in_all_lanes(binning.lo[axis]), scale = in_all_lanes(binning.scale[axis]);
    const Float4 limit = in_all_lanes(static_cast<float>(split.last_left + 1));
    const Float4 beyond = in_all_lanes(std::numeric_limits<float>::infinity());
    Box4 left, right;  // local, in registers
    BuildReference* middle = references;
    for (BuildReference* place = references; place != references + size; ++place) {
        const Float4 along = in_all_lanes(place->center2(axis));
        const Int4 is_left = (along - lo) * scale < limit;  // -1 in each lane where true
        const Whole here(*place), there(*middle);
        BuildReference* const to = middle;
        middle -= is_left[0];
        there.store(*place);
        here.store(*to);
        const Float4 center2 = here.center2();
        left.lo = lesser(chosen(is_left, center2, beyond), left.lo);
        left.hi = greater(chosen(is_left, center2, -beyond), left.hi);
        right.lo = lesser(chosen(is_left, beyond, center2), right.lo);
        right.hi = greater(chosen(is_left, -beyond, center2), right.hi);
    }
    left_centers = left;
    right_centers = right;
    return static_cast<std::uint32_t>(middle - references);
}

ObjectSplit sweep_few(const BuildReference* references, std::size_t size,
                      const SweepPlaces& places, Int4 wide, const LeafKind& kind) {
    Sides boxes[kSweepSize];
    for (std::size_t i = 0; i < size; ++i) boxes[i] = Sides(references[i]);
    Float4 right_cost[kSweepSize];
    AxisSides right;
    for (std::size_t i = size - 1; i > 0; --i) {
        for (std::size_t axis = 0; axis < 3; ++axis) right.of[axis].include(boxes[places[axis][i]]);
        const auto blocks = static_cast<float>(kind.blocks(static_cast<std::uint32_t>(size - i)));
        right_cost[i] = right.weights() * kind.cost * blocks;
    }
    AxisSplits splits;
    AxisSides left;
    for (std::size_t i = 0; i + 1 < size; ++i) {
        for (std::size_t axis = 0; axis < 3; ++axis) left.of[axis].include(boxes[places[axis][i]]);
        const auto blocks = static_cast<float>(kind.blocks(static_cast<std::uint32_t>(i + 1)));
        splits.offer(left.weights() * kind.cost * blocks + right_cost[i + 1], wide,
                     static_cast<int>(i));
    }
    ObjectSplit best = splits.best();
    if (best.axis < 0) return best;
    const auto& order = places[static_cast<std::size_t>(best.axis)];
    const auto middle = static_cast<std::size_t>(best.last_left) + 1;
    Sides of_left, of_right;
    of_left.clear();
    of_right.clear();
    for (std::size_t i = 0; i < middle; ++i) of_left.include(boxes[order[i]]);
    for (std::size_t i = middle; i < size; ++i) of_right.include(boxes[order[i]]);
    best.left = box_of_sides(of_left);
    best.right = box_of_sides(of_right);
    return best;
}

}  // namespace

const SplitKernels& split_kernels_of_target() {
    static constexpr SplitKernels kKernels{&fill_bins, &add_bins, &best_of_plain_bins,
                                           &divide_by_bins, &sweep_few};
    return kKernels;
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace alhazen {

ALHAZEN_KERNEL_TABLE(split_kernels_of_target);

const SplitKernels& split_kernels() {
    return ALHAZEN_KERNEL(split_kernels_of_target)();
}

}  // namespace alhazen
#endif
