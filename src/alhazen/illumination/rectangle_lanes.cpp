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
HWY_INLINE Doubles clamped(const Doubles& v, const Doubles& lo, const Doubles& hi) {
    return select_lanes(v < lo, lo, select_lanes(hi < v, hi, v));
}
/// std::max(a, b) of each lane.
HWY_INLINE Doubles larger(const Doubles& a, const Doubles& b) {
    return select_lanes(a < b, b, a);
}
HWY_INLINE Doubles root_of_sum(const Doubles& a, const Doubles& b) {
    return sqrt(a * a + b * b);
}

/// SphericalRectangle and its `point`, operation by operation.
void draw_rectangles(RectangleLanes::Numbers& n) {
    const Doubles one(1.0), zero(0.0), minus_one(-1.0);
    const LaneVectors corner = load_vectors(n.corner), axis_x = load_vectors(n.x);
    const LaneVectors axis_y = load_vectors(n.y);
    LaneVectors axis_z = load_vectors(n.z);
    Doubles z0 = dot(corner, axis_z);
    const LaneMask<double> turned = z0 > zero;
    axis_z = select_lanes(turned, -axis_z, axis_z);
    z0 = select_lanes(turned, -z0, z0);
    // A rectangle edge on is sampled by `sample`; -1 avoids a division by 0 in its lane.
    const LaneMask<double> before = z0 < zero;
    z0 = select_lanes(before, z0, minus_one);
    const Doubles x0 = dot(corner, axis_x), y0 = dot(corner, axis_y);
    const Doubles x1 = x0 + load_lanes(n.width), y1 = y0 + load_lanes(n.height);
    const auto across = [&](const Doubles& a) { return one / root_of_sum(a, z0); };
    const Doubles z_of_0 = -y0 * across(y0), z_of_1 = x1 * across(x1);
    const Doubles z_of_2 = y1 * across(y1), z_of_3 = -x0 * across(x0);
    const auto product = [&](const Doubles& a, const Doubles& b) {
        return clamped(-a * b, minus_one, one);
    };
    const Doubles cosines[4] = {product(z_of_0, z_of_1), product(z_of_1, z_of_2),
                                product(z_of_2, z_of_3), product(z_of_3, z_of_0)};
    Doubles g[4];
    acos_of_lanes(cosines, g);
    const Doubles k = Doubles(2.0 * kPi) - g[2] - g[3];
    const Doubles solid_angle = larger(zero, g[0] + g[1] - k);

    const Doubles au = load_lanes(n.u[0]) * solid_angle + k;
    const SineCosine of_au = sine_cosine_of_lanes(au);
    const Doubles fu = (of_au.cosine * z_of_0 - z_of_2) / of_au.sine;
    const Doubles cu = clamped(copysign(one, fu) / sqrt(fu * fu + z_of_0 * z_of_0), minus_one, one);
    const Doubles x = clamped(-(cu * z0) / sqrt(larger(zero, one - cu * cu)), x0, x1);
    const Doubles d = root_of_sum(x, z0);
    const Doubles h0 = y0 / root_of_sum(d, y0), h1 = y1 / root_of_sum(d, y1);
    const Doubles h = h0 + load_lanes(n.u[1]) * (h1 - h0), rest = one - h * h;
    const LaneMask<double> inner = rest > Doubles(1e-14);
    const Doubles root = sqrt(select_lanes(inner, rest, one));
    const Doubles y = select_lanes(inner, clamped(h * d / root, y0, y1), y1);
    const LaneVectors offset = x * axis_x + y * axis_y + z0 * axis_z;
    const Doubles distance = sqrt(dot(offset, offset));
    store_vectors(offset / distance, n.to_light);
    store_lanes(distance, n.distance);
    store_lanes(one / solid_angle, n.density);
    n.shining = n.two_sided | bits_of(dot(corner, load_vectors(n.normal)) < zero);
    n.drawn = bits_of(before & (solid_angle > Doubles(kLeastSolidAngle)));
}

}  // namespace

void draw_rectangles_of_target(RectangleLanes::Numbers& numbers) {
    draw_rectangles(numbers);
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
    }
}

void RectangleLanes::set(std::size_t lane, const Emitter& e, const Vec3& from, const Vec2& u) {
    const auto put = [lane](const Vec3& v, double(&values)[3][kMost]) {
        for (int k = 0; k < 3; ++k) values[k][lane] = v[k];
    };
    if (emitters_[lane] != &e) {
        emitters_[lane] = &e;
        put(e.sides.x, numbers_.x);
        put(e.sides.y, numbers_.y);
        put(e.sides.z, numbers_.z);
        put(e.world_from_own.linear.z_axis, numbers_.normal);
        const std::uint32_t bit = 1u << lane;
        numbers_.two_sided = e.two_sided ? numbers_.two_sided | bit : numbers_.two_sided & ~bit;
        numbers_.width[lane] = e.sides.width;
        numbers_.height[lane] = e.sides.height;
    }
    from_[lane] = from;
    put(e.world_from_own.translation - from, numbers_.corner);
    numbers_.u[0][lane] = u.x;
    numbers_.u[1][lane] = u.y;
}

void RectangleLanes::draw() {
    ALHAZEN_KERNEL(draw_rectangles_of_target)(numbers_);
}

EmitterSample RectangleLanes::sampled(std::size_t lane) const {
    const Emitter& e = *emitters_[lane];
    const Numbers& n = numbers_;
    if ((n.drawn >> lane & 1u) == 0) {
        return sample(e, from_[lane], {n.u[0][lane], n.u[1][lane]});
    }
    if ((n.shining >> lane & 1u) == 0) return {};
    return {{n.to_light[0][lane], n.to_light[1][lane], n.to_light[2][lane]},
            n.distance[lane],
            n.density[lane],
            {}};
}

}  // namespace alhazen
#endif
