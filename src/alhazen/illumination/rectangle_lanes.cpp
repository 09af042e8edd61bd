#include "alhazen/illumination/rectangle_lanes.h"

#include "alhazen/simd/dispatch.h"

// Compiles the rest of this file once per target.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "alhazen/illumination/rectangle_lanes.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// After foreach_target.h.
#include "alhazen/math/constants.h"
#include "alhazen/simd/angles-inl.h"
#include "alhazen/simd/lane_vectors-inl.h"

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
    const D one(1.0), zero(0.0);
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
    z0 = select_lanes(before, z0, D(-1.0));
    const D x0 = dot(corner, axis_x), y0 = dot(corner, axis_y);
    const D x1 = x0 + load_lanes<N>(n.width), y1 = y0 + load_lanes<N>(n.height);
    const D unit = one / -z0;
    const D ux0 = x0 * unit, ux1 = x1 * unit, uy0 = y0 * unit, uy1 = y1 * unit;
    const D xx0 = ux0 * ux0, xx1 = ux1 * ux1, yy0 = one + uy0 * uy0, yy1 = one + uy1 * uy1;
    const D w0 = sqrt(yy0), w1 = sqrt(yy1);
    const D r00 = sqrt(xx0 + yy0), r01 = sqrt(xx0 + yy1);
    const D r10 = sqrt(xx1 + yy0), r11 = sqrt(xx1 + yy1);
    const D yy = uy0 * uy1, size = one / ((one + xx0) * (w0 * w1));
    const D start_cosine = (xx0 * yy + r00 * r01) * size;
    const D start_sine = ux0 * (uy1 * r00 - uy0 * r01) * size;
    const D end_x = xx1 * yy + r10 * r11, end_y = ux1 * (uy1 * r10 - uy0 * r11);
    const D sine_of_all = end_y * start_cosine - end_x * start_sine;
    const D angle = angle_from_axis(sine_of_all, end_x * start_cosine + end_y * start_sine);
    const LaneMask<double, N> is_reflex = (end_y > zero) & (start_sine < zero);
    const D reflex = select_lanes(is_reflex, D(2.0 * kPi) - angle, zero);
    const D solid_angle = select_lanes(sine_of_all < zero, reflex, angle);

    const SineCosine<N> share = sine_cosine_at(load_lanes<N>(calls.u[0]) * solid_angle);
    const D sine = start_sine * share.cosine + start_cosine * share.sine;
    const D cosine = start_cosine * share.cosine - start_sine * share.sine;
    const D p = w0 * uy1 - w1 * uy0 * cosine, q = w1 * sine;
    const D rest_of_x = larger(D(SphericalRectangle::kTiny), (p - q) * (p + q));
    const D x = clamped(w0 * q / sqrt(rest_of_x) * -z0, x0, x1);
    const D d = x * x + z0 * z0;
    const D h0 = y0 / sqrt(d + y0 * y0), h1 = y1 / sqrt(d + y1 * y1);
    const D h = h0 + load_lanes<N>(calls.u[1]) * (h1 - h0), rest = one - h * h;
    const LaneMask<double, N> inner = rest > D(1e-14);
    const D y =
        select_lanes(inner, clamped(h * sqrt(d / select_lanes(inner, rest, one)), y0, y1), y1);
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
    write(abs(dot(to_light, load_vectors<N>(n.normal))), results.facing);
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
    emitters_[lane] = &e;
    const Affine& world = e.world_from_own;
    set_rectangle(lane, e, world.translation, world.linear.z_axis, e.sides);
    if (radiance != nullptr) {
        const Spectrum light = kColorChannels.emission(*radiance);
        set_radiance(lane, &light);
    } else {
        set_radiance(lane, nullptr);
    }
}

void RectangleLanes::set_flat(std::size_t lane, const FlatEmitter& e) {
    set_rectangle(lane, e, e.corner, e.normal, RectangleSides::of(e.x, e.y));
}

template <class AnyEmitter>
void RectangleLanes::set_rectangle(std::size_t lane, const AnyEmitter& e, const Vec3& corner,
                                   const Vec3& normal, const RectangleSides& sides) {
    const auto put = [lane](const Vec3& v, double(&values)[3][kMost]) {
        for (int k = 0; k < 3; ++k) values[k][lane] = v[k];
    };
    put(corner, numbers_.corner);
    put(sides.x, numbers_.x);
    put(sides.y, numbers_.y);
    put(sides.z, numbers_.z);
    put(normal, numbers_.normal);
    numbers_.width[lane] = sides.width;
    numbers_.height[lane] = sides.height;
    numbers_.far_squared[lane] = e.far_squared;
    numbers_.in_plane[lane] = e.in_plane;
    const std::uint32_t bit = 1u << lane;
    numbers_.two_sided = e.two_sided ? numbers_.two_sided | bit : numbers_.two_sided & ~bit;
}

void RectangleLanes::set_radiance(std::size_t lane, const Spectrum* radiance) {
    const std::uint32_t bit = 1u << lane;
    std::uint32_t& varying = numbers_.drawn.varying;
    varying = radiance == nullptr ? varying | bit : varying & ~bit;
    const Spectrum light = radiance != nullptr ? *radiance : Spectrum{};
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
            {},
            r.facing[lane]};
}

}  // namespace alhazen
#endif
