/// Makes the rays of the slab test: see slab_ray.h.
///
/// Conventions: included once per target (see simd/lanes-inl.h).

#if defined(ALHAZEN_WIDE_BVH_SLAB_RAY_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ALHAZEN_WIDE_BVH_SLAB_RAY_INL_H_
#undef ALHAZEN_WIDE_BVH_SLAB_RAY_INL_H_
#else
#define ALHAZEN_WIDE_BVH_SLAB_RAY_INL_H_
#endif

#include <array>
#include <bit>

#include "alhazen/accel/wide_bvh/slab_ray.h"
#include "alhazen/accel/wide_bvh/wide_node.h"
#include "alhazen/geometry/ray.h"
#include "alhazen/simd/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {

/// Rays as they come, turned into lanes: origin, direction, t_min, t_max.
template <std::size_t N>
struct RayLanes {
    alignas(64) double component[8][N];

    HWY_INLINE void set(std::size_t lane, const Ray& ray) {
        const auto values = std::bit_cast<std::array<double, 8>>(ray);
        for (std::size_t i = 0; i < 8; ++i) component[i][lane] = values[i];
    }
    [[nodiscard]] HWY_INLINE Lanes<double, N> get(std::size_t i) const {
        return load_lanes<N>(component[i]);
    }
    [[nodiscard]] HWY_INLINE Lanes<double, N> t_min() const { return get(6); }
    [[nodiscard]] HWY_INLINE Lanes<double, N> t_max() const { return get(7); }
};

template <std::size_t N>
HWY_INLINE Lanes<double, N> largest(const Lanes<double, N> (&v)[3]) {
    return max_lanes(max_lanes(abs(v[0]), abs(v[1])), abs(v[2]));
}
template <std::size_t N>
HWY_INLINE Lanes<double, N> dot(const Lanes<double, N> (&a)[3], const Lanes<double, N> (&b)[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// The local parameters of t, rounded down and up, still in double: they stay on their side when
/// rounded to float.
template <std::size_t N>
struct LocalParameters {
    Lanes<double, N> scale, shift;

    [[nodiscard]] HWY_INLINE Lanes<double, N> below(const Lanes<double, N>& t) const {
        const Lanes<double, N> s = t * scale;
        const Lanes<double, N> x = s - shift - slack(s);
        return x - float_step(x);
    }
    [[nodiscard]] HWY_INLINE Lanes<double, N> above(const Lanes<double, N>& t) const {
        const Lanes<double, N> s = t * scale;
        const Lanes<double, N> x = s - shift + slack(s);
        return x + float_step(x);
    }

  private:
    [[nodiscard]] HWY_INLINE Lanes<double, N> slack(const Lanes<double, N>& s) const {
        return Lanes<double, N>(kLocalSlack) * (abs(s) + abs(shift));
    }
    [[nodiscard]] static HWY_INLINE Lanes<double, N> float_step(const Lanes<double, N>& x) {
        return abs(x) * Lanes<double, N>(0x1p-23) + Lanes<double, N>(0x1p-100);
    }
};

/// Every box is met; a free slot still is not: its planes are infinite.
template <std::size_t N>
HWY_INLINE void pass_everything(SlabRays<N>& slabs, std::size_t ray) {
    for (std::size_t k = 0; k < 3; ++k) {
        slabs.origin[k][ray] = 0.0;
        slabs.direction[k][ray] = 1.0;
        slabs.reciprocal[k][ray] = 1.0f;
        slabs.near_offset[k][ray] = -1e30f;
        slabs.far_offset[k][ray] = 1e30f;
        slabs.near_plane[k][ray] = static_cast<std::uint32_t>(kWideNodeWidth * k);
        slabs.far_plane[k][ray] = static_cast<std::uint32_t>(kWideNodeWidth * (k + 3));
    }
    slabs.octant[ray] = 0;
    slabs.s_min[ray] = -std::numeric_limits<float>::infinity();
    slabs.s_max[ray] = std::numeric_limits<float>::infinity();
    slabs.t_scale[ray] = slabs.t_shift[ray] = slabs.delta[ray] = slabs.reach[ray] = 0;
}

/// The rays must be valid.
template <std::size_t N>
HWY_INLINE void make_slab_rays(const LocalFrame& frame, const RayLanes<N>& rays,
                               SlabRays<N>& slabs) {
    using D = Lanes<double, N>;
    D o[3], d[3];
    for (std::size_t k = 0; k < 3; ++k) {
        o[k] = (rays.get(k) - D(frame.center[static_cast<int>(k)])) * D(frame.scale);
        d[k] = rays.get(k + 3);
    }
    const D distance = largest<N>(o);
    const D length = largest<N>(d);
    D power, inverse_power;
    powers_of_two(length, power, inverse_power);
    LocalParameters<N> local{power * D(frame.scale), D(0.0)};
    // Outside these limits (never in a real scene) exponents could leave the range of double: here,
    // or in the test in double, whose products have the third power of a length.
    const bool scene_regular = frame.scale >= 0x1p-200 && frame.scale <= 0x1p200;
    const std::uint32_t regular =
        scene_regular
            ? bits_of((distance <= D(0x1p40)) & (length >= D(0x1p-200)) & (length <= D(0x1p200)))
            : 0;
    for (std::size_t k = 0; k < 3; ++k) d[k] = d[k] * inverse_power;
    const auto far = distance > D(2.0);
    if (bits_of(far) != 0) {
        local.shift = select(far, -dot<N>(o, d) / dot<N>(d, d), D(0.0));
        for (std::size_t k = 0; k < 3; ++k) o[k] = o[k] + local.shift * d[k];
    }
    const D delta = D(kExactTestSlack) * (distance + D(1.0 + frame.offset));
    const D reach = largest<N>(o) + D(1.0) + delta + delta;
    const D constant_slack = D(0x1p-24 * 2.2) * reach;
    const D slope_slack = D(0x1p-24) + D(0x1p-23) * reach + delta;
    std::uint32_t down[3];
    for (std::size_t k = 0; k < 3; ++k) {
        const D steep = copysign(max_lanes(abs(d[k]), D(0x1p-60)), d[k]);
        const D reciprocal = rounded_to_float(D(1.0) / steep);
        const D c = -(o[k] * reciprocal);
        const D slack = constant_slack + slope_slack * abs(reciprocal);
        store_as_floats(reciprocal, slabs.reciprocal[k]);
        store_as_floats(c - slack, slabs.near_offset[k]);
        store_as_floats(c + slack, slabs.far_offset[k]);
        store_lanes(o[k], slabs.origin[k]);
        store_lanes(d[k], slabs.direction[k]);
        down[k] = bits_of(steep < D(0.0));
    }
    for (std::size_t i = 0; i < N; ++i) {
        std::uint32_t octant = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t sign = down[k] >> i & 1;
            const auto near = static_cast<std::uint32_t>(kWideNodeWidth * (k + 3 * sign));
            slabs.near_plane[k][i] = near;
            slabs.far_plane[k][i] = static_cast<std::uint32_t>(kWideNodeWidth * (2 * k + 3)) - near;
            octant |= sign << k;
        }
        slabs.octant[i] = octant;
    }
    store_lanes(local.scale, slabs.t_scale);
    store_lanes(local.shift, slabs.t_shift);
    store_lanes(delta, slabs.delta);
    store_lanes(reach, slabs.reach);
    store_as_floats(local.below(rays.t_min()), slabs.s_min);
    store_as_floats(local.above(rays.t_max()), slabs.s_max);
    for (std::uint32_t rest = ~regular & ((1u << N) - 1); rest != 0; rest &= rest - 1) {
        pass_everything(slabs, static_cast<std::size_t>(std::countr_zero(rest)));
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#endif  // include guard that opens again for every target
