#include "alhazen/imaging/image/code_lanes.h"

#include <algorithm>

#include "alhazen/simd/dispatch.h"

// Compiles the rest of this file once per target.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "alhazen/imaging/image/code_lanes.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// After foreach_target.h.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {
namespace {

std::uint16_t linear_code(double c, double most, double offset) {
    const double clamped = c > 0.0 ? std::min(c, 1.0) : 0.0;  // NaN: 0
    return std::uint16_t(most * clamped + offset);
}

}  // namespace

void linear_codes_of_target(const double* values, double most, double offset,
                            std::span<std::uint16_t> codes) {
    std::size_t i = 0;
#if HWY_TARGET != HWY_SCALAR
    namespace hn = hwy::HWY_NAMESPACE;
    const hn::CappedTag<double, 4> d;
    const hn::Rebind<std::int32_t, decltype(d)> whole;
    const hn::Rebind<std::uint16_t, decltype(d)> narrow;
    const auto zero = hn::Zero(d), one = hn::Set(d, 1.0);
    const auto scale = hn::Set(d, most), shift = hn::Set(d, offset);
    for (; i + hn::Lanes(d) <= codes.size(); i += hn::Lanes(d)) {
        const auto c = hn::LoadU(d, values + i);
        const auto clamped = hn::Min(hn::IfThenElseZero(hn::Gt(c, zero), c), one);
        const auto code = hn::Add(hn::Mul(scale, clamped), shift);
        // A conversion to integers truncates.
        hn::StoreU(hn::DemoteTo(narrow, hn::DemoteTo(whole, code)), narrow, codes.data() + i);
    }
#endif
    for (; i < codes.size(); ++i) codes[i] = linear_code(values[i], most, offset);
}

bool narrow_codes_of_target(std::span<const std::uint16_t> codes, std::uint8_t* bytes) {
    std::size_t i = 0;
    std::uint16_t all = 0;
#if HWY_TARGET != HWY_SCALAR
    namespace hn = hwy::HWY_NAMESPACE;
    const hn::CappedTag<std::uint16_t, 16> d;
    const hn::Rebind<std::int16_t, decltype(d)> whole;
    const hn::Rebind<std::uint8_t, decltype(d)> narrow;
    const auto byte = hn::Set(d, 255);
    auto any = hn::Zero(d);
    for (; i + hn::Lanes(d) <= codes.size(); i += hn::Lanes(d)) {
        const auto code = hn::LoadU(d, codes.data() + i);
        any = hn::Or(any, code);
        // TruncateTo mixes up the operands of a permutation in Highway 1.0.3 for AVX3_DL.
        const auto low = hn::BitCast(whole, hn::And(code, byte));
        hn::StoreU(hn::DemoteTo(narrow, low), narrow, bytes + i);
    }
    if (!hn::AllFalse(d, hn::Gt(any, byte))) all = 256;
#endif
    for (; i < codes.size(); ++i) {
        all = std::uint16_t(all | codes[i]);
        bytes[i] = std::uint8_t(codes[i]);
    }
    return all <= 255;
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace alhazen {

ALHAZEN_KERNEL_TABLE(linear_codes_of_target);
ALHAZEN_KERNEL_TABLE(narrow_codes_of_target);

void linear_codes(const double* values, double most, double offset,
                  std::span<std::uint16_t> codes) {
    ALHAZEN_KERNEL(linear_codes_of_target)(values, most, offset, codes);
}

bool narrow_codes(std::span<const std::uint16_t> codes, std::uint8_t* bytes) {
    return ALHAZEN_KERNEL(narrow_codes_of_target)(codes, bytes);
}

}  // namespace alhazen
#endif
