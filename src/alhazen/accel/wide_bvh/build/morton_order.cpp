#include "alhazen/accel/wide_bvh/build/morton_order.h"

#include <algorithm>
#include <array>
#include <utility>

#include "alhazen/parallel/parallel.h"

namespace alhazen {
namespace {

constexpr int kDigitBits = 11;
constexpr std::size_t kDigits = std::size_t{1} << kDigitBits;
/// Fewer points are sorted by comparison.
constexpr std::size_t kLeastForDigits = 1024;

/// Parts of a pass over `size` entries. Few, because each counts all digits; equal ones and an even
/// number of them, for two threads.
std::size_t part_size(std::size_t size) {
    const std::size_t parts = 2 * std::clamp<std::size_t>(size / 24576, 1, 4);
    return (size + parts - 1) / parts;
}

/// One stable pass of a radix sort: parts are counted, then written, in parallel.
void sort_by_digit(std::span<const std::uint64_t> from, std::uint64_t* to, int shift) {
    const std::size_t part = part_size(from.size());
    std::vector<std::array<std::uint32_t, kDigits>> places((from.size() - 1) / part + 1);
    const auto digit = [shift](std::uint64_t e) { return e >> shift & (kDigits - 1); };
    parallel_for(from.size(), part, [&](std::size_t begin, std::size_t end) {
        std::uint32_t* const counts = places[begin / part].data();
        const std::uint64_t* const entries = from.data();
        for (std::size_t i = begin; i < end; ++i) ++counts[digit(entries[i])];
    });
    std::uint32_t next = 0;
    for (std::size_t d = 0; d < kDigits; ++d) {
        for (auto& place : places) next += std::exchange(place[d], next);
    }
    parallel_for(from.size(), part, [&](std::size_t begin, std::size_t end) {
        std::uint32_t* const place = places[begin / part].data();
        const std::uint64_t* const entries = from.data();
        for (std::size_t i = begin; i < end; ++i) to[place[digit(entries[i])]++] = entries[i];
    });
}

constexpr std::size_t kPointsAtOnce = 8192;

/// Calls use(point, i) for the points from `begin` to `end`.
template <class Use>
void for_points(const CurvePoints& points, std::size_t begin, std::size_t end, Use&& use) {
    constexpr std::size_t kFew = 512;  // in the nearest cache
    Float4 few[kFew];
    for (std::size_t i = begin; i < end; i += kFew) {
        const std::size_t count = std::min(kFew, end - i);
        points.make(i, i + count, few);
        for (std::size_t k = 0; k < count; ++k) use(few[k], i + k);
    }
}

Box4 box_of(const CurvePoints& points) {
    std::vector<Box4> parts((points.size - 1) / kPointsAtOnce + 1);
    parallel_for(points.size, kPointsAtOnce, [&](std::size_t begin, std::size_t end) {
        Box4 box;
        for_points(points, begin, end, [&](Float4 p, std::size_t) { box.include_point(p); });
        parts[begin / kPointsAtOnce] = box;
    });
    Box4 all;
    for (const Box4& part : parts) all.include(part);
    return all;
}

}  // namespace

CurveGrid::CurveGrid(const Box4& box) : lo_(box.lo) {
    float side[3];
    for (int axis = 0; axis < 3; ++axis) {
        const float extent = box.hi[axis] - box.lo[axis];
        const bool some = extent > 0.0f && extent < 1e30f && 2048.0f / extent < 1e37f;
        side[axis] = some ? extent : 0.0f;
    }
    // The axes from the highest bit of the code to the lowest.
    std::array<int, 32> axes;
    int bits[3]{}, all = 0;
    while (all < 32) {
        int longest = -1;
        for (int axis = 0; axis < 3; ++axis) {
            if (side[axis] == 0.0f || bits[axis] == kAxisBits) continue;
            if (longest < 0 || side[axis] > side[longest]) longest = axis;
        }
        if (longest < 0) break;
        side[longest] *= 0.5f;
        ++bits[longest];
        axes[static_cast<std::size_t>(all++)] = longest;
    }
    std::uint32_t bit_of[3][kAxisBits];
    int left[3] = {bits[0], bits[1], bits[2]};
    for (int i = 0; i < all; ++i) {
        const int axis = axes[static_cast<std::size_t>(i)];
        bit_of[axis][--left[axis]] = 1u << (31 - i);
    }
    for (int axis = 0; axis < 3; ++axis) {
        const auto cells = static_cast<float>(1u << bits[axis]);
        if (bits[axis] > 0) scale_[axis] = cells / (box.hi[axis] - box.lo[axis]);
        most_[axis] = cells - 1.0f;
        const auto fill = [&](std::uint32_t* codes, int first, int count) {
            codes[0] = 0;
            for (int bit = 0; bit < count; ++bit) {
                const std::uint32_t value =
                    first + bit < bits[axis] ? bit_of[axis][first + bit] : 0;
                for (std::uint32_t i = 0; i < 1u << bit; ++i)
                    codes[i + (1u << bit)] = codes[i] | value;
            }
        };
        fill(low_[axis], 0, kLowBits);
        fill(high_[axis], kLowBits, kAxisBits - kLowBits);
    }
    most_[3] = 0.0f;
}

CurveGrid::Codes::Codes(const CurveGrid& grid) : grid_(grid) {
    static_assert(kAxisBits == 11);
    for (int axis = 0; axis < 3; ++axis) {
        const auto cells = static_cast<std::uint32_t>(grid.most_[axis]) + 1;
        for (std::uint32_t i = 0; i < cells; ++i) {
            all_[axis][i] = grid.low_[axis][i % kLow] | grid.high_[axis][i / kLow];
        }
    }
}

CurveOrder::CurveOrder(const CurvePoints& points, HugeRoom& room)
    : size_(points.size), entries_(room.take<Entry>(points.size)) {
    if (size_ == 0) return;
    Entry* other = room.take<Entry>(size_);
    const CurveGrid grid(box_of(points));
    const CurveGrid::Codes code(grid);
    parallel_for(size_, kPointsAtOnce, [&](std::size_t begin, std::size_t end) {
        Entry* const to = entries_;
        for_points(points, begin, end, [&](Float4 p, std::size_t i) {
            to[i] = std::uint64_t{code(p)} << 32 | i;
        });
    });
    sort(entries_, other, size_);
    const std::vector<Run> crowded = crowded_cells();
    if (crowded.empty()) return;
    rest_ = make_huge_array<std::uint32_t>(size_);
    parallel_for(size_, kPointsAtOnce, [&](std::size_t begin, std::size_t end) {
        std::fill(rest_.get() + begin, rest_.get() + end, 0u);
    });
    parallel_for(crowded.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) divide_cell(crowded[i], points);
    });
}

/// Sorts by the upper halves; `other` has as much room. Exchanges the two.
void CurveOrder::sort(Entry*& entries, Entry*& other, std::size_t size) {
    if (size < kLeastForDigits) {
        std::sort(entries, entries + size);
        return;
    }
    for (int shift = 32; shift < 64; shift += kDigitBits) {
        sort_by_digit({entries, size}, other, shift);
        std::swap(entries, other);
    }
}

std::vector<CurveOrder::Run> CurveOrder::crowded_cells() const {
    std::vector<std::vector<Run>> parts((size_ - 1) / kPointsAtOnce + 1);
    if (size_ <= kCurveLeafSize) return {};
    parallel_for(size_ - kCurveLeafSize, kPointsAtOnce, [&](std::size_t begin, std::size_t end) {
        const Entry* const entries = entries_;
        const auto cell = [entries](std::size_t i) { return entries[i] >> 32; };
        // A run belongs to the part that it begins in.
        for (std::size_t i = begin; i < end; ++i) {
            if ((entries[i] ^ entries[i + kCurveLeafSize]) >> 32 != 0) continue;
            if (i > 0 && cell(i - 1) == cell(i)) continue;
            std::size_t last = i + kCurveLeafSize + 1;
            while (last < size_ && cell(last) == cell(i)) ++last;
            parts[begin / kPointsAtOnce].push_back({i, last});
            i = last - 1;
        }
    });
    std::vector<Run> all;
    for (const auto& part : parts) all.insert(all.end(), part.begin(), part.end());
    return all;
}

/// Sorts the points of a cell by the places in a grid over them.
void CurveOrder::divide_cell(Run run, const CurvePoints& points) {
    const std::size_t count = run.end - run.begin;
    const auto its = make_huge_array<Float4>(count);
    Box4 box;
    for (std::size_t i = 0; i < count; ++i) {
        const std::uint32_t number = index(run.begin + i);
        points.make(number, number + 1, &its[i]);
        box.include_point(its[i]);
    }
    const CurveGrid grid(box);
    const auto room = make_huge_array<Entry>(2 * count);
    Entry *inner = room.get(), *other = inner + count;
    for (std::size_t i = 0; i < count; ++i) {
        inner[i] = std::uint64_t{grid.code(its[i])} << 32 | index(run.begin + i);
    }
    sort(inner, other, count);
    const Entry cell = entries_[run.begin] >> 32 << 32;
    for (std::size_t i = 0; i < count; ++i) {
        entries_[run.begin + i] = cell | static_cast<std::uint32_t>(inner[i]);
        rest_[run.begin + i] = static_cast<std::uint32_t>(inner[i] >> 32);
    }
}

}  // namespace alhazen
