/// math/angles.h in lanes, operation by operation: the same bits.
///
/// Conventions: those of lanes-inl.h.

#if defined(ALHAZEN_SIMD_ANGLES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ALHAZEN_SIMD_ANGLES_INL_H_
#undef ALHAZEN_SIMD_ANGLES_INL_H_
#else
#define ALHAZEN_SIMD_ANGLES_INL_H_
#endif

#include "alhazen/math/angles.h"
#include "alhazen/math/constants.h"
#include "alhazen/simd/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {

template <std::size_t N>
struct SineCosine {
    Lanes<double, N> sine, cosine;
};

namespace angle_lanes {

template <std::size_t kFirst, std::size_t N, std::size_t kCount>
HWY_INLINE Lanes<double, N> every_second(const Lanes<double, N>& squared,
                                         const double (&coefficients)[kCount]) {
    using D = Lanes<double, N>;
    if constexpr (kFirst + 2 >= kCount) {
        return D(coefficients[kFirst]);
    } else {
        return every_second<kFirst + 2>(squared, coefficients) * squared + D(coefficients[kFirst]);
    }
}
template <std::size_t N, std::size_t kCount>
HWY_INLINE Lanes<double, N> polynomial(const Lanes<double, N>& x,
                                       const double (&coefficients)[kCount]) {
    return every_second<1>(x * x, coefficients) * x + every_second<0>(x * x, coefficients);
}

/// `direction_beside`.
template <std::size_t N>
HWY_INLINE SineCosine<N> sine_cosine_beside(const Lanes<double, N>& quarter,
                                            const Lanes<double, N>& t) {
    using D = Lanes<double, N>;
    const D z = t * t;
    const D sine = t + t * (z * polynomial(z, angles::kSine));
    const D cosine = (D(1.0) - D(0.5) * z) + z * z * polynomial(z, angles::kCosine);
    const auto within = [&](double low, double high) {
        return (quarter > D(low)) & (quarter < D(high));
    };
    const LaneMask<double, N> odd = within(0.5, 1.5) | within(2.5, 3.5);
    const D s = select_lanes(odd, cosine, sine), c = select_lanes(odd, sine, cosine);
    return {select_lanes(within(1.5, 3.5), -s, s), select_lanes(within(0.5, 2.5), -c, c)};
}

}  // namespace angle_lanes

template <std::size_t N>
HWY_INLINE Lanes<double, N> angle_from_axis(const Lanes<double, N>& y, const Lanes<double, N>& x) {
    using D = Lanes<double, N>;
    const D size_y = abs(y), size_x = abs(x);
    const LaneMask<double, N> steep = size_y > size_x;
    const D low = select_lanes(steep, size_x, size_y), high = select_lanes(steep, size_y, size_x);
    const LaneMask<double, N> outer = low > D(angles::kHalfOctant) * high;
    const D tiny(angles::kTiny), usable = select_lanes(high < tiny, tiny, high);
    const D t = select_lanes(outer, low - high, low) / select_lanes(outer, low + high, usable);
    const D z = t * t, arc = t + t * (z * angle_lanes::polynomial(z, angles::kArc));
    const D in_octant = select_lanes(outer, D(0.25 * kPi) + arc, arc);
    const D in_quarter = select_lanes(steep, D(0.5 * kPi) - in_octant, in_octant);
    return select_lanes(x < D(0.0), D(kPi) - in_quarter, in_quarter);
}

/// `direction_at`.
template <std::size_t N>
HWY_INLINE SineCosine<N> sine_cosine_at(const Lanes<double, N>& angle) {
    using D = Lanes<double, N>;
    const D rounder(angles::kRounder);
    const D quarter = (angle * D(2.0 / kPi) + rounder) - rounder;
    return angle_lanes::sine_cosine_beside(
        quarter, (angle - quarter * D(angles::kQuarter)) - quarter * D(angles::kQuarterRest));
}

/// `direction_after`.
template <std::size_t N>
HWY_INLINE SineCosine<N> sine_cosine_after(const Lanes<double, N>& turns) {
    using D = Lanes<double, N>;
    const D rounder(angles::kRounder);
    const D quarters = D(4.0) * turns, quarter = (quarters + rounder) - rounder;
    return angle_lanes::sine_cosine_beside(quarter, D(0.5 * kPi) * (quarters - quarter));
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#endif  // include guard, toggled for every target
