/// Prepares rays for the slab test: see slab_ray.h.
///
/// Conventions: included once per target (see simd/lanes-inl.h). The axes are in lanes.

#if defined(ALHAZEN_ACCEL_WIDE_BVH_TRACE_SLAB_RAY_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ALHAZEN_ACCEL_WIDE_BVH_TRACE_SLAB_RAY_INL_H_
#undef ALHAZEN_ACCEL_WIDE_BVH_TRACE_SLAB_RAY_INL_H_
#else
#define ALHAZEN_ACCEL_WIDE_BVH_TRACE_SLAB_RAY_INL_H_
#endif

#include <algorithm>
#include <bit>
#include <cstddef>

#include "alhazen/accel/wide_bvh/trace/slab_ray.h"
#include "alhazen/simd/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {

/// A ray in the local frame, in registers, from which the float tests of nodes and leaves are
/// prepared.
struct AxisLanes {
    using F = Lanes<float, 4>;
    F origin, direction;      ///< [axis]; origin after the shift; the fourth is arbitrary
    float reach, delta;       ///< as in FrameSlack
    Lanes<float, 2> sure;     ///< the beginning of the ray's range rounded up, the end rounded down
    std::uint32_t main_axis;  ///< index of the largest component of the direction
    bool regular;             ///< as in LocalRay
    LocalParameter parameter;
};

/// The lower half of the lanes.
template <std::size_t N>
HWY_INLINE Lanes<float, N / 2> lower_half(const Lanes<float, N>& a) {
    Lanes<float, N / 2> r;
    if constexpr (kParts<float, N> == 2 * kParts<float, N / 2>) {
        for (std::size_t i = 0; i < kParts<float, N / 2>; ++i) r.part[i] = a.part[i];
#if HWY_TARGET != HWY_SCALAR  // the scalar target has nothing to divide
    } else {
        r.part[0] = hn::LowerHalf(LaneTag<float, N / 2>(), a.part[0]);
#endif
    }
    return r;
}

/// The axes in lanes, twice where that takes one register: each is in every lane then by one step
/// within its half.
inline constexpr std::size_t kAxisCopies = kParts<float, 8> == 1 ? 2 : 1;
using AxesTwice = Lanes<float, 4 * kAxisCopies>;

template <std::size_t N = 4 * kAxisCopies>
HWY_INLINE Lanes<float, N> twice(const AxisLanes::F& a) {
    if constexpr (N == 8) {
        return joined(a, a);
    } else {
        return a;
    }
}
template <std::size_t N>
HWY_INLINE AxisLanes::F once(const Lanes<float, N>& a) {
    if constexpr (N == 8) {
        return lower_half(a);
    } else {
        return a;
    }
}

/// The largest magnitude of the first three of each four lanes in all four; a NaN is greater than
/// any number. `size`: the magnitudes.
HWY_INLINE AxesTwice largest_of_axes(const AxesTwice& size) {
    HWY_ALIGN static constexpr std::uint32_t kKeep[8] = {~0u, ~0u, ~0u, 0, ~0u, ~0u, ~0u, 0};
    AxesTwice three;
    const LaneTag<float, 4 * kAxisCopies> d;
    const hn::RebindToUnsigned<LaneTag<float, 4 * kAxisCopies>> du;
    ALHAZEN_UNROLL
    for (std::size_t i = 0; i < kParts<float, 4 * kAxisCopies>; ++i) {
        const auto keep = hn::BitCast(d, hn::Load(du, kKeep + i * hn::Lanes(d)));
        three.part[i] = hn::And(size.part[i], keep);
    }
    return largest_of_fours(three);
}
/// A magnitude with the sign of `a`, whose own is `size`.
HWY_INLINE AxesTwice with_sign(const AxesTwice& magnitude, const AxesTwice& a,
                               const AxesTwice& size) {
    AxesTwice r;
    ALHAZEN_UNROLL
    for (std::size_t i = 0; i < kParts<float, 4 * kAxisCopies>; ++i) {
        r.part[i] = hn::Xor3(magnitude.part[i], a.part[i], size.part[i]);
    }
    return r;
}

/// What the slab test needs of a ray, in registers.
struct SlabLanes {
    AxesTwice reciprocal, near_offset, far_offset;
    Lanes<float, 2> range;  ///< s_min, s_max
    NearRows near;
};

HWY_INLINE void store_slab_ray(const SlabLanes& lanes, SlabRay& slabs) {
    static_assert(offsetof(SlabRay, s_max) == offsetof(SlabRay, s_min) + sizeof(float));
    store_lanes(once(lanes.reciprocal), slabs.reciprocal);
    store_lanes(once(lanes.near_offset), slabs.near_offset);
    store_lanes(once(lanes.far_offset), slabs.far_offset);
    // Two members, addressed relative to the whole object.
    store_lanes(lanes.range,
                reinterpret_cast<float*>(&slabs) + offsetof(SlabRay, s_min) / sizeof(float));
    slabs.near = lanes.near;
}

/// Lane `kLane` of the first four in every lane.
template <std::size_t kLane, std::size_t N, std::size_t M>
HWY_INLINE Lanes<float, N> spread(const Lanes<float, M>& a) {
#if HWY_TARGET == HWY_SCALAR
    return Lanes<float, N>(hn::GetLane(a.part[kLane]));
#else
    if constexpr (N == M && M == 4 * kAxisCopies) {
        Lanes<float, N> r;
        r.part[0] = hn::Broadcast<static_cast<int>(kLane)>(a.part[0]);
        return r;
    } else {
        return Lanes<float, N>(hn::GetLane(hn::Broadcast<static_cast<int>(kLane)>(a.part[0])));
    }
#endif
}

/// The bits of the lanes whose sign is set, of zeros and NaN, too.
HWY_INLINE std::uint32_t sign_bits(const AxisLanes::F& a) {
#if HWY_ARCH_X86 && HWY_TARGET != HWY_SCALAR
    return static_cast<std::uint32_t>(_mm_movemask_ps(a.part[0].raw));
#else
    const LaneTag<float, 4> d;
    const hn::RebindToSigned<LaneTag<float, 4>> di;
    LaneMask<float, 4> negative;
    for (std::size_t i = 0; i < kParts<float, 4>; ++i) {
        negative.part[i] = hn::RebindMask(d, hn::Lt(hn::BitCast(di, a.part[i]), hn::Zero(di)));
    }
    return bits_of(negative);
#endif
}

/// Sets the ray's rows of planes. `slack`: of the slab test, for a direction of length 1, in every
/// lane. `octant`: as in NearRows.
HWY_INLINE void make_slab_rows(const AxesTwice& origin, const AxesTwice& direction,
                               const AxesTwice& slack, std::uint32_t octant, SlabLanes& slabs) {
    using F = AxesTwice;
    // The length is at least 2^-40, so its bound is independent of this one of the components.
    const F size = abs(direction);
    const F steep = with_sign(max_lanes(size, F(0x1p-100f)), direction, size);
    slabs.reciprocal = F(1.0f) / steep;
    const F c = neg_mul_add(origin, slabs.reciprocal, F(0.0f));
    const F aside = slack * abs(slabs.reciprocal);
    slabs.near_offset = c - aside;
    slabs.far_offset = c + aside;
    slabs.near = kNearRows[octant];
}

/// A ray in the local frame, without a shift, of which the slab test has been prepared.
struct NearbyRay {
    AxisLanes::F origin, direction;  ///< as in AxisLanes
    float reach;                     ///< the largest coordinate of the origin

    /// Magnitudes of the direction.
    [[nodiscard]] HWY_INLINE AxisLanes::F size() const { return first_three(abs(direction)); }
    /// The largest of them.
    [[nodiscard]] HWY_INLINE AxisLanes::F length() const { return largest_of_fours(size()); }
};

/// Two of four numbers: compilers read all four where they are used.
HWY_INLINE Lanes<float, 2> first_two(const float (&values)[4]) {
    return lower_half(load_lanes<4>(values));
}
/// The range of a ray in local parameters, rounded to the nearest.
HWY_INLINE Lanes<float, 2> nearby_range(const LocalFrame& frame, const Ray& ray) {
    using D2 = Lanes<double, 2>;
    static_assert(offsetof(Ray, t_max) == offsetof(Ray, t_min) + sizeof(double));
    HWY_ALIGN static constexpr float kMost[4] = {1e37f, 1e37f};
    // The scale is a power of two, so only the rounding to float counts. The ends are finite in
    // float, beyond every scene, and not negative.
    return min_lanes(as_floats(load_unaligned<2>(&ray.t_min) * D2(frame.scale)), first_two(kMost));
}
HWY_ALIGN inline constexpr float kRangeStep[4] = {0x1p-100f, -0x1p-100f};

/// The first part of `make_ray_nearby`. False as there, but it is not asked whether t_max is
/// below t_min: the range is empty then, or nearly.
HWY_INLINE bool start_nearby(const LocalFrame& frame, const DistanceBound& bound, const Ray& ray,
                             SlabLanes& slabs, NearbyRay& nearby) {
    using D = Lanes<double, 4>;
    using F = AxesTwice;
    static_assert(offsetof(Ray, direction) == 24 && offsetof(LocalFrame, scale) == 24);
    static_assert(offsetof(Ray, t_min) == offsetof(Ray, direction) + 3 * sizeof(double));
    const AxisLanes::F origin4 = as_floats(
        (load_unaligned<4>(&ray.origin.x) - load_unaligned<4>(&frame.center.x)) * D(frame.scale));
    const AxisLanes::F direction4 = as_floats(load_unaligned<4>(&ray.direction.x));  // and t_min
    const std::uint32_t signs = sign_bits(direction4);
    const F origin = twice(origin4), direction = twice(direction4);
    const F reaches = largest_of_axes(abs(origin)), lengths = largest_of_axes(abs(direction));
    // Not negative, so in the order of their bits; those of NaN are greater than any number's.
    const auto reach = std::bit_cast<std::uint32_t>(first_lane(reaches));
    const auto length = std::bit_cast<std::uint32_t>(first_lane(lengths));
    if (reach > std::bit_cast<std::uint32_t>(8.0f) ||
        length > std::bit_cast<std::uint32_t>(0x1p40f) ||
        length < std::bit_cast<std::uint32_t>(frame.slack.least_length) || signs > 7) {
        return false;
    }
    nearby = {once(origin), once(direction), first_lane(reaches)};
    make_slab_rows(origin, direction, mul_add(reaches, F(bound.slope), F(bound.constant)), signs,
                   slabs);
    HWY_ALIGN static constexpr float kWider[4] = {1.0f - 0x1p-22f, 1.0f + 0x1p-22f};
    slabs.range =
        max_lanes(mul_sub(nearby_range(frame, ray), first_two(kWider), first_two(kRangeStep)),
                  Lanes<float, 2>(0.0f));
    return true;
}

/// The second part of `make_ray_nearby`.
HWY_INLINE void finish_nearby(const LocalFrame& frame, const Ray& ray, const NearbyRay& nearby,
                              AxisLanes& axes) {
    axes.origin = nearby.origin;
    axes.direction = nearby.direction;
    axes.main_axis = static_cast<std::uint32_t>(
        hwy::Num0BitsBelowLS1Bit_Nonzero32(bits_of(nearby.size() >= nearby.length())));
    axes.delta = frame.slack.delta.at(nearby.reach);
    axes.reach = frame.slack.reach.at(nearby.reach);
    axes.regular = true;
    axes.parameter = {frame.scale, 0.0};
    HWY_ALIGN static constexpr float kNarrower[4] = {1.0f + 0x1p-22f, 1.0f - 0x1p-22f};
    axes.sure = mul_add(nearby_range(frame, ray), first_two(kNarrower), first_two(kRangeStep));
}

/// Sets `axes` without a shift, and `slabs`. False if the ray is invalid, far from the scene or of
/// an unusual length. `bound`: as in `make_ray`.
HWY_INLINE bool make_ray_nearby(const LocalFrame& frame, const DistanceBound& bound, const Ray& ray,
                                SlabRay& slabs, AxisLanes& axes) {
    SlabLanes lanes;
    NearbyRay nearby;
    if (!(ray.t_min <= ray.t_max)) return false;
    if (!start_nearby(frame, bound, ray, lanes, nearby)) return false;
    store_slab_ray(lanes, slabs);
    finish_nearby(frame, ray, nearby, axes);
    return true;
}

/// As `make_ray`, for the rays that make_ray_nearby rejects.
HWY_NOINLINE inline bool make_ray_from_afar(const LocalFrame& frame, const Ray& ray, SlabRay& slabs,
                                            AxisLanes& axes) {
    const LocalRay local = local_ray_from_afar(frame, ray);
    if (!local.valid) return false;
    axes.origin = load_lanes<4>(local.origin);
    axes.direction = load_lanes<4>(local.direction);
    axes.reach = local.reach;
    axes.delta = local.delta;
    HWY_ALIGN const float sure[2] = {local.above[0], local.below[1]};
    axes.sure = load_lanes<2>(sure);
    axes.main_axis = local.main_axis;
    axes.regular = local.regular;
    axes.parameter = local.parameter;
    if (!local.regular) {
        pass_everything(slabs);
        return true;
    }
    const float slack = 6.5f * 0x1p-24f * local.reach + 1.001f * local.delta;
    SlabLanes lanes;
    make_slab_rows(twice(axes.origin), twice(axes.direction), AxesTwice(slack),
                   sign_bits(axes.direction) & 7, lanes);
    lanes.range = Lanes<float, 2>(0.0f);
    store_slab_ray(lanes, slabs);
    slabs.s_min = std::max(0.0f, local.below[0]);  // in this order -0 becomes 0
    slabs.s_max = local.above[1];
    return true;
}

/// Prepares a ray for nodes, then calls `then(axes)` to prepare it for leaves. Returns false,
/// without the call, for an invalid ray. `bound`: the slack of the slab test, frame.slack.slab for
/// exact results.
template <class Then>
HWY_INLINE bool make_ray(const LocalFrame& frame, const DistanceBound& bound, const Ray& ray,
                         SlabRay& slabs, Then&& then) {
    {
        AxisLanes axes;
        if (HWY_LIKELY(make_ray_nearby(frame, bound, ray, slabs, axes))) {
            then(axes);
            return true;
        }
    }
    AxisLanes axes;
    if (!make_ray_from_afar(frame, ray, slabs, axes)) return false;
    then(axes);
    return true;
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#endif  // include guard that opens again for every target
