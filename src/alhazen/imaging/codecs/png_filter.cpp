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

/// Adds those of one byte.
void add_costs(const std::uint8_t* x, const std::uint8_t* above, std::size_t pixel, Sums& sums) {
    const int a = *(x - pixel), b = *above, c = *(above - pixel);
    sums[0] += cost(*x, 0);
    sums[1] += cost(*x, a);
    sums[2] += cost(*x, b);
    sums[3] += cost(*x, (a + b) / 2);
    sums[4] += cost(*x, paeth(a, b, c));
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
        // The lanes' mean is rounded up.
        const Vector odd = hn::And(hn::Xor(a, b), hn::Set(d, 1));
        none = hn::Add(none, costs(here, hn::Zero(d)));
        sub = hn::Add(sub, costs(here, a));
        up = hn::Add(up, costs(here, b));
        average = hn::Add(average, costs(here, hn::Sub(hn::AverageRound(a, b), odd)));
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

}  // namespace

PngFilter best_png_filter_of_target(std::span<const std::uint8_t> row, const std::uint8_t* above,
                                    std::size_t pixel) {
    Sums sums;
    sum_costs(row, above, pixel, sums);
    return PngFilter(std::min_element(sums.begin(), sums.end()) - sums.begin());
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace alhazen {

ALHAZEN_KERNEL_TABLE(best_png_filter_of_target);

PngFilter best_png_filter(std::span<const std::uint8_t> row, std::span<const std::uint8_t> above,
                          std::size_t pixel) {
    return ALHAZEN_KERNEL(best_png_filter_of_target)(row, above.data(), pixel);
}

}  // namespace alhazen
#endif
