#include "alhazen/verification/met_boxes.h"

#include "alhazen/simd/dispatch.h"

// Compiles the rest of this file once per target.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "alhazen/verification/met_boxes.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// After foreach_target.h.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

/// Vectors of floats, at most a group wide.
using MetTag = hn::CappedTag<float, BoxList::kGroup>;

std::size_t met_in_lanes(const BoxList& boxes, const BoxLine& line, std::size_t begin,
                         std::size_t end, std::uint32_t* met) {
    const MetTag d;
    const std::size_t lanes = hn::Lanes(d);
    const std::size_t ahead = line.axis, first = (ahead + 1) % 3, second = (ahead + 2) % 3;
    const auto start_a = hn::Set(d, line.start[0]), start_b = hn::Set(d, line.start[1]);
    const auto slope_a = hn::Set(d, line.slope[0]), slope_b = hn::Set(d, line.slope[1]);
    const auto steep_a = hn::Abs(slope_a), steep_b = hn::Abs(slope_b);
    std::size_t count = 0;
    for (std::size_t i = begin; i < end; i += lanes) {
        const auto x = hn::LoadU(d, &boxes.center[ahead][i]);
        const auto half_x = hn::LoadU(d, &boxes.half[ahead][i]);
        const auto half_a = hn::LoadU(d, &boxes.half[first][i]);
        const auto half_b = hn::LoadU(d, &boxes.half[second][i]);
        const auto a = hn::Sub(hn::LoadU(d, &boxes.center[first][i]), start_a);
        const auto b = hn::Sub(hn::LoadU(d, &boxes.center[second][i]), start_b);
        const auto off_a = hn::Abs(hn::NegMulAdd(slope_a, x, a));
        const auto off_b = hn::Abs(hn::NegMulAdd(slope_b, x, b));
        const auto meets = hn::And(hn::Le(off_a, hn::MulAdd(steep_a, half_x, half_a)),
                                   hn::Le(off_b, hn::MulAdd(steep_b, half_x, half_b)));
        if (hn::AllFalse(d, meets)) continue;
        std::uint8_t bits[BoxList::kGroup / 8 + 8] = {};
        hn::StoreMaskBits(d, meets, bits);
        for (std::size_t k = 0; k < lanes; ++k) {
            if ((bits[k / 8] >> (k % 8)) & 1) met[count++] = static_cast<std::uint32_t>(i + k);
        }
    }
    return count;
}

}  // namespace

auto met_boxes_kernel() -> decltype(&met_in_lanes) {
    return &met_in_lanes;
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace alhazen {

ALHAZEN_KERNEL_TABLE(met_boxes_kernel);

std::size_t met_boxes(const BoxList& boxes, const BoxLine& line, std::size_t begin, std::size_t end,
                      std::uint32_t* met) {
    static const auto kernel = ALHAZEN_KERNEL(met_boxes_kernel)();
    return kernel(boxes, line, begin, end, met);
}

void BoxList::reserve(std::size_t count) {
    for (std::size_t k = 0; k < 3; ++k) {
        center[k].reserve(count + kGroup);
        half[k].reserve(count + kGroup);
    }
}

void BoxList::add(const Box3& box) {
    const Vec3 middle = box.center(), size = box.size();
    for (std::size_t k = 0; k < 3; ++k) {
        const int axis = static_cast<int>(k);
        center[k].push_back(static_cast<float>(middle[axis]));
        half[k].push_back(static_cast<float>(0.5 * size[axis]) + kMargin);
    }
}

void BoxList::fill() {
    while (center[0].size() % kGroup != 0) {
        for (std::size_t k = 0; k < 3; ++k) {
            center[k].push_back(0);
            half[k].push_back(-1e30f);
        }
    }
}

}  // namespace alhazen
#endif
