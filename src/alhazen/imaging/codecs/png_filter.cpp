#include "alhazen/imaging/codecs/png_filter.h"

#include <algorithm>
#include <array>

#include "alhazen/simd/dispatch.h"

// Compiles the rest of this file once per target.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "alhazen/imaging/codecs/png_filter.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// After foreach_target.h.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

constexpr std::size_t kFilters = 5;
using Sums = std::array<std::uint64_t, kFilters>;

/// |difference| of a byte and its prediction, as a signed byte.
std::uint8_t cost(int byte, int predicted) {
    const int difference = (byte - predicted) & 255;
    return static_cast<std::uint8_t>(std::min(difference, 256 - difference));
}

int paeth(int a, int b, int c) {
    const int pa = std::abs(b - c), pb = std::abs(a - c), pc = std::abs(a + b - 2 * c);
    if (pa <= pb && pa <= pc) return a;
    return pb <= pc ? b : c;
}

/// By the filter, from the bytes to the left, above, and above to the left.
int prediction(PngFilter filter, int a, int b, int c) {
    switch (filter) {
        case PngFilter::None:
            return 0;
        case PngFilter::Sub:
            return a;
        case PngFilter::Up:
            return b;
        case PngFilter::Average:
            return (a + b) / 2;
        case PngFilter::Paeth:
            return paeth(a, b, c);
    }
    return 0;
}

/// Adds those of one byte.
void add_costs(const std::uint8_t* x, const std::uint8_t* above, std::size_t pixel, Sums& sums) {
    const int a = *(x - pixel), b = *above, c = *(above - pixel);
    for (std::size_t filter = 0; filter < kFilters; ++filter) {
        sums[filter] += cost(*x, prediction(PngFilter(filter), a, b, c));
    }
}

#if HWY_TARGET != HWY_SCALAR
using Bytes = hn::CappedTag<std::uint8_t, 32>;
using Vector = hn::Vec<Bytes>;
using Sum = hn::Vec<hn::Repartition<std::uint64_t, Bytes>>;

HWY_INLINE Vector distance(Vector p, Vector q) {
    return hn::Or(hn::SaturatedSub(p, q), hn::SaturatedSub(q, p));
}

HWY_INLINE Vector paeth(Vector a, Vector b, Vector c) {
    const Vector pa = distance(b, c), pb = distance(a, c);
    // |a + b - 2 c| is pa + pb, which exceeds both, where b - c and a - c have the same sign, and
    // else their distance.
    const auto same = hn::Eq(hn::VecFromMask(Bytes(), hn::Eq(hn::Min(b, c), c)),
                             hn::VecFromMask(Bytes(), hn::Eq(hn::Min(a, c), c)));
    const Vector pc = hn::IfThenElse(same, hn::SaturatedAdd(pa, pb), distance(pa, pb));
    const Vector b_or_c = hn::IfThenElse(hn::Eq(hn::Min(pb, pc), pb), b, c);
    const auto nearest = hn::Eq(hn::Min(hn::Min(pa, pb), pc), pa);
    return hn::IfThenElse(nearest, a, b_or_c);
}

/// Rounded down.
HWY_INLINE Vector mean(Vector a, Vector b) {
    const Vector odd = hn::And(hn::Xor(a, b), hn::Set(Bytes(), 1));
    return hn::Sub(hn::AverageRound(a, b), odd);
}

HWY_INLINE Vector prediction(PngFilter filter, Vector a, Vector b, Vector c) {
    switch (filter) {
        case PngFilter::None:
            return hn::Zero(Bytes());
        case PngFilter::Sub:
            return a;
        case PngFilter::Up:
            return b;
        case PngFilter::Average:
            return mean(a, b);
        case PngFilter::Paeth:
            return paeth(a, b, c);
    }
    return hn::Zero(Bytes());
}

HWY_INLINE Sum costs(Vector x, Vector predicted) {
    const Vector difference = hn::Sub(x, predicted);
    return hn::SumsOf8(hn::Min(difference, hn::Sub(hn::Zero(Bytes()), difference)));
}
#endif

void sum_costs(std::span<const std::uint8_t> row, const std::uint8_t* above, std::size_t pixel,
               Sums& sums) {
    const std::uint8_t* const x = row.data();
    std::size_t i = 0;
    sums = {};
#if HWY_TARGET != HWY_SCALAR
    const Bytes d;
    const hn::Repartition<std::uint64_t, Bytes> wide;
    Sum none = hn::Zero(wide), sub = none, up = none, average = none, best = none;
    for (; i + hn::Lanes(d) <= row.size(); i += hn::Lanes(d)) {
        const Vector here = hn::LoadU(d, x + i);
        const Vector a = hn::LoadU(d, x + i - pixel), b = hn::LoadU(d, above + i),
                     c = hn::LoadU(d, above + i - pixel);
        none = hn::Add(none, costs(here, hn::Zero(d)));
        sub = hn::Add(sub, costs(here, a));
        up = hn::Add(up, costs(here, b));
        average = hn::Add(average, costs(here, mean(a, b)));
        best = hn::Add(best, costs(here, paeth(a, b, c)));
    }
    const auto total = [&](Sum lanes) {
        HWY_ALIGN std::array<std::uint64_t, hn::MaxLanes(wide)> parts;
        hn::Store(lanes, wide, parts.data());
        std::uint64_t sum = 0;
        for (const std::uint64_t part : parts) sum += part;
        return sum;
    };
    sums = {total(none), total(sub), total(up), total(average), total(best)};
#endif
    for (; i < row.size(); ++i) add_costs(x + i, above + i, pixel, sums);
}

/// Subtracts the predictions of the filter.
template <PngFilter filter>
void subtract(std::span<const std::uint8_t> row, const std::uint8_t* above, std::size_t pixel,
              std::uint8_t* filtered) {
    const std::uint8_t* const x = row.data();
    std::size_t i = 0;
#if HWY_TARGET != HWY_SCALAR
    const Bytes d;
    for (; i + hn::Lanes(d) <= row.size(); i += hn::Lanes(d)) {
        const Vector a = hn::LoadU(d, x + i - pixel), b = hn::LoadU(d, above + i),
                     c = hn::LoadU(d, above + i - pixel);
        hn::StoreU(hn::Sub(hn::LoadU(d, x + i), prediction(filter, a, b, c)), d, filtered + i);
    }
#endif
    for (; i < row.size(); ++i) {
        const int a = *(x + i - pixel), b = above[i], c = *(above + i - pixel);
        filtered[i] = std::uint8_t(x[i] - prediction(filter, a, b, c));
    }
}

}  // namespace

PngFilter best_png_filter_of_target(std::span<const std::uint8_t> row, const std::uint8_t* above,
                                    std::size_t pixel) {
    Sums sums;
    sum_costs(row, above, pixel, sums);
    return PngFilter(std::min_element(sums.begin(), sums.end()) - sums.begin());
}

void apply_png_filter_of_target(PngFilter filter, std::span<const std::uint8_t> row,
                                const std::uint8_t* above, std::size_t pixel,
                                std::uint8_t* filtered) {
    switch (filter) {
        case PngFilter::None:
            return subtract<PngFilter::None>(row, above, pixel, filtered);
        case PngFilter::Sub:
            return subtract<PngFilter::Sub>(row, above, pixel, filtered);
        case PngFilter::Up:
            return subtract<PngFilter::Up>(row, above, pixel, filtered);
        case PngFilter::Average:
            return subtract<PngFilter::Average>(row, above, pixel, filtered);
        case PngFilter::Paeth:
            return subtract<PngFilter::Paeth>(row, above, pixel, filtered);
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace alhazen {

ALHAZEN_KERNEL_TABLE(best_png_filter_of_target);
ALHAZEN_KERNEL_TABLE(apply_png_filter_of_target);

PngFilter best_png_filter(std::span<const std::uint8_t> row, std::span<const std::uint8_t> above,
                          std::size_t pixel) {
    return ALHAZEN_KERNEL(best_png_filter_of_target)(row, above.data(), pixel);
}

void apply_png_filter(PngFilter filter, std::span<const std::uint8_t> row,
                      std::span<const std::uint8_t> above, std::size_t pixel,
                      std::uint8_t* filtered) {
    ALHAZEN_KERNEL(apply_png_filter_of_target)(filter, row, above.data(), pixel, filtered);
}

}  // namespace alhazen
#endif
