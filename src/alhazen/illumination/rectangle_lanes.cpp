#include "alhazen/illumination/rectangle_lanes.h"

#include "alhazen/simd/dispatch.h"

// Compiles the rest of this file once per target.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "alhazen/illumination/rectangle_lanes.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// After foreach_target.h.
#include "alhazen/math/constants.h"
#include "alhazen/simd/lane_vectors-inl.h"
#include "alhazen/simd/trigonometry-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {
namespace {

/// std::clamp of each lane, for NaNs, too.
template <std::size_t N>
HWY_INLINE Lanes<double, N> clamped(const Lanes<double, N>& v, const Lanes<double, N>& lo,
                                    const Lanes<double, N>& hi) {
    return select_lanes(v < lo, lo, select_lanes(hi < v, hi, v));
}
/// std::max(a, b) of each lane.
template <std::size_t N>
HWY_INLINE Lanes<double, N> larger(const Lanes<double, N>& a, const Lanes<double, N>& b) {
    return select_lanes(a < b, b, a);
}
template <std::size_t N>
HWY_INLINE Lanes<double, N> root_of_sum(const Lanes<double, N>& a, const Lanes<double, N>& b) {
    return sqrt(a * a + b * b);
}

/// Sets the lanes of `to` that are in `lanes`.
template <std::size_t N>
HWY_INLINE void set_lanes(const LaneMask<double, N>& lanes, const Lanes<double, N>& from,
                          double* to) {
    store_lanes(select_lanes(lanes, from, load_lanes<N>(to)), to);
}

/// SphericalRectangle and its `point`, operation by operation, for the first N lanes.
template <std::size_t N>
HWY_INLINE void draw_rectangles(std::uint32_t lanes, const LightCallLanes& calls,
                                RectangleLanes::Numbers& n, LightDrawLanes& results) {
    using D = Lanes<double, N>;
    using Vectors = VectorLanes<N>;
    const D one(1.0), zero(0.0), minus_one(-1.0);
    const Vectors corner = load_vectors<N>(n.corner) - load_vectors<N>(calls.at.point);
    // `is_sampled_by_area`.
    const D height_above = dot(corner, load_vectors<N>(n.normal));
    const LaneMask<double, N> by_area = (dot(corner, corner) > load_lanes<N>(n.far_squared)) |
                                        (abs(height_above) <= load_lanes<N>(n.in_plane));
    if ((lanes & ~bits_of(by_area)) == 0) {
        n.drawn.sampled = n.drawn.shining = 0;
        return;
    }
    const Vectors axis_x = load_vectors<N>(n.x), axis_y = load_vectors<N>(n.y);
    Vectors axis_z = load_vectors<N>(n.z);
    D z0 = dot(corner, axis_z);
    const LaneMask<double, N> turned = z0 > zero;
    axis_z = select_lanes(turned, -axis_z, axis_z);
    z0 = select_lanes(turned, -z0, z0);
    // A rectangle edge on is sampled by `sample`; -1 avoids a division by 0 in its lane.
    const auto before = (z0 < zero) & !by_area;
    z0 = select_lanes(before, z0, minus_one);
    const D x0 = dot(corner, axis_x), y0 = dot(corner, axis_y);
    const D x1 = x0 + load_lanes<N>(n.width), y1 = y0 + load_lanes<N>(n.height);
    const auto across = [&](const D& a) { return one / root_of_sum(a, z0); };
    const D z_of_0 = -y0 * across(y0), z_of_1 = x1 * across(x1);
    const D z_of_2 = y1 * across(y1), z_of_3 = -x0 * across(x0);
    const auto product = [&](const D& a, const D& b) { return clamped(-a * b, minus_one, one); };
    const D cosines[4] = {product(z_of_0, z_of_1), product(z_of_1, z_of_2), product(z_of_2, z_of_3),
                          product(z_of_3, z_of_0)};
    D g[4];
    acos_of_lanes(cosines, g);
    const D k = D(2.0 * kPi) - g[2] - g[3];
    const D solid_angle = larger(zero, g[0] + g[1] - k);

    const D au = load_lanes<N>(calls.u[0]) * solid_angle + k;
    const SineCosine<N> of_au = sine_cosine_of_lanes(au);
    const D fu = (of_au.cosine * z_of_0 - z_of_2) / of_au.sine;
    const D cu = clamped(copysign(one, fu) / sqrt(fu * fu + z_of_0 * z_of_0), minus_one, one);
    const D x = clamped(-(cu * z0) / sqrt(larger(zero, one - cu * cu)), x0, x1);
    const D d = root_of_sum(x, z0);
    const D h0 = y0 / root_of_sum(d, y0), h1 = y1 / root_of_sum(d, y1);
    const D h = h0 + load_lanes<N>(calls.u[1]) * (h1 - h0), rest = one - h * h;
    const LaneMask<double, N> inner = rest > D(1e-14);
    const D root = sqrt(select_lanes(inner, rest, one));
    const D y = select_lanes(inner, clamped(h * d / root, y0, y1), y1);
    const Vectors offset = x * axis_x + y * axis_y + z0 * axis_z;
    const D distance = sqrt(dot(offset, offset)), density = one / solid_angle;

    const std::uint32_t sampled = bits_of(before & (solid_angle > D(kLeastSolidAngle)) & !by_area);
    const std::uint32_t towards = bits_of(height_above < zero);
    n.drawn.sampled = lanes & sampled;
    n.drawn.shining = n.drawn.sampled & (n.two_sided | towards);
    const LaneMask<double, N> set = lanes_of_bits<double, N>(n.drawn.sampled);
    const LaneMask<double, N> shining = lanes_of_bits<double, N>(n.drawn.shining);
    const auto write = [&](const D& value, double* to) {
        set_lanes(set, select_lanes(shining, value, zero), to);
    };
    const Vectors to_light = offset / distance;
    write(to_light.x, results.to_light[0]);
    write(to_light.y, results.to_light[1]);
    write(to_light.z, results.to_light[2]);
    write(distance, results.distance);
    write(load_lanes<N>(n.probability) * density, results.density);
    store_lanes(density, n.density);
    for (int i = 0; i < Spectrum::kCount; ++i) {
        write(load_lanes<N>(n.radiance[i]), results.radiance[i]);
    }
    results.singular &= ~n.drawn.sampled;
}

}  // namespace

void draw_rectangles_of_target(std::uint32_t lanes, const LightCallLanes& calls,
                               RectangleLanes::Numbers& numbers, LightDrawLanes& results) {
    with_lane_count(lanes, [&](auto count) HWY_ATTR {
        draw_rectangles<decltype(count)::value>(lanes, calls, numbers, results);
    });
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace alhazen {

ALHAZEN_KERNEL_TABLE(draw_rectangles_of_target);

RectangleLanes::RectangleLanes() {
    for (std::size_t lane = 0; lane < kMost; ++lane) {
        numbers_.corner[2][lane] = -1.0;
        numbers_.x[0][lane] = numbers_.y[1][lane] = numbers_.z[2][lane] = 1.0;
        numbers_.width[lane] = numbers_.height[lane] = 1.0;
        numbers_.in_plane[lane] = -1.0;
    }
}

void RectangleLanes::set_emitter(std::size_t lane, const Emitter& e, const Rgb* radiance) {
    const auto put = [lane](const Vec3& v, double(&values)[3][kMost]) {
        for (int k = 0; k < 3; ++k) values[k][lane] = v[k];
    };
    emitters_[lane] = &e;
    put(e.world_from_own.translation, numbers_.corner);
    put(e.sides.x, numbers_.x);
    put(e.sides.y, numbers_.y);
    put(e.sides.z, numbers_.z);
    put(e.world_from_own.linear.z_axis, numbers_.normal);
    numbers_.width[lane] = e.sides.width;
    numbers_.height[lane] = e.sides.height;
    numbers_.far_squared[lane] = e.far_squared;
    numbers_.in_plane[lane] = e.in_plane;
    const std::uint32_t bit = 1u << lane;
    const auto mark = [bit](bool holds, std::uint32_t& lanes) {
        lanes = holds ? lanes | bit : lanes & ~bit;
    };
    mark(e.two_sided, numbers_.two_sided);
    mark(radiance == nullptr, numbers_.drawn.varying);
    const Spectrum light = radiance != nullptr ? kColorChannels.emission(*radiance) : Spectrum{};
    for (int k = 0; k < Spectrum::kCount; ++k) numbers_.radiance[k][lane] = light[k];
}

RectangleLanes::Drawn RectangleLanes::draw(std::uint32_t lanes, const LightCallLanes& calls,
                                           LightDrawLanes& results) {
    ALHAZEN_KERNEL(draw_rectangles_of_target)(lanes, calls, numbers_, results);
    return numbers_.drawn;
}

EmitterSample RectangleLanes::sampled(std::size_t lane, const LightCallLanes& calls,
                                      const LightDrawLanes& results) const {
    if ((numbers_.drawn.sampled >> lane & 1u) == 0) {
        return sample(*emitters_[lane], calls.at.point_of(lane), calls.u_of(lane));
    }
    if ((numbers_.drawn.shining >> lane & 1u) == 0) return {};
    const LightDrawLanes& r = results;
    return {{r.to_light[0][lane], r.to_light[1][lane], r.to_light[2][lane]},
            r.distance[lane],
            numbers_.density[lane],
            {}};
}

}  // namespace alhazen
#endif
