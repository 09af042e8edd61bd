#include "alhazen/illumination/area_lanes.h"

#include "alhazen/simd/dispatch.h"

// Compiles the rest of this file once per target.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "alhazen/illumination/area_lanes.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// After foreach_target.h.
#include <limits>

#include "alhazen/simd/lane_vectors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {
namespace area_lanes {

/// `is_sampled_by_area`, `point_of`, `seen_by_area` and Illumination::draw, operation by operation.
template <std::size_t N>
HWY_INLINE void draw(std::uint32_t lanes, const LightCallLanes& calls, AreaLanes::Numbers& n,
                     LightDrawLanes& results) {
    using D = Lanes<double, N>;
    using Vectors = VectorLanes<N>;
    const D zero(0.0), one(1.0);
    const Vectors corner = load_vectors<N>(n.corner), normal = load_vectors<N>(n.normal);
    const Vectors from = load_vectors<N>(calls.at.point), to_corner = corner - from;
    const Vectors x = load_vectors<N>(n.x), y = load_vectors<N>(n.y);
    const D away = dot(to_corner, to_corner), height = dot(to_corner, normal);
    const LaneMask<double, N> by_area =
        (away > load_lanes<N>(n.far_squared)) | (abs(height) <= load_lanes<N>(n.in_plane));
    n.drawn = lanes & bits_of(by_area);

    const D u = load_lanes<N>(calls.u[0]), v = load_lanes<N>(calls.u[1]), root = sqrt(u);
    const LaneMask<double, N> triangle = lanes_of_bits<double, N>(n.triangles);
    const D second = select_lanes(triangle, root * (one - v), u);
    const D third = select_lanes(triangle, root * v, v);
    const Vectors point = second * x + third * y + zero * normal + corner;
    const Vectors offset = point - from;
    const D squared = dot(offset, offset), distance = sqrt(squared);
    const LaneMask<double, N> apart = distance > zero;
    const Vectors to_light = offset / select_lanes(apart, distance, one);
    D cosine = -dot(to_light, normal);
    cosine = select_lanes(lanes_of_bits<double, N>(n.two_sided), abs(cosine), cosine);
    const LaneMask<double, N> towards = cosine > zero;
    const D density = load_lanes<N>(n.area_density) * squared / select_lanes(towards, cosine, one);
    const LaneMask<double, N> usable =
        (density > zero) & (density <= D(std::numeric_limits<double>::max()));
    const LaneMask<double, N> shining = apart & towards & usable;
    n.shining = n.drawn & bits_of(shining);

    const LaneMask<double, N> set = lanes_of_bits<double, N>(n.drawn);
    const auto write = [&](const D& value, double* to) {
        store_lanes(select_lanes(set, select_lanes(shining, value, zero), load_lanes<N>(to)), to);
    };
    write(to_light.x, results.to_light[0]);
    write(to_light.y, results.to_light[1]);
    write(to_light.z, results.to_light[2]);
    write(distance, results.distance);
    write(cosine, results.facing);
    write(load_lanes<N>(n.probability) * density, results.density);
    for (int i = 0; i < Spectrum::kCount; ++i) {
        write(load_lanes<N>(n.radiance[i]), results.radiance[i]);
    }
    results.singular &= ~n.drawn;
    store_lanes(select_lanes(triangle, second, zero), n.weights[0]);
    store_lanes(select_lanes(triangle, third, zero), n.weights[1]);
}

}  // namespace area_lanes

void draw_by_area_of_target(std::uint32_t lanes, const LightCallLanes& calls,
                            AreaLanes::Numbers& numbers, LightDrawLanes& results) {
    with_lane_count(lanes, [&](auto count) HWY_ATTR {
        area_lanes::draw<decltype(count)::value>(lanes, calls, numbers, results);
    });
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace alhazen {

ALHAZEN_KERNEL_TABLE(draw_by_area_of_target);

FlatEmitter::FlatEmitter(const Emitter& e, std::uint32_t radiance_number)
    : corner(e.world_from_own.translation),
      x(e.world_from_own.linear.x_axis),
      y(e.world_from_own.linear.y_axis),
      normal(e.world_from_own.linear.z_axis),
      density(e.area > 0.0 ? 1.0 / e.area : 0.0),
      far_squared(e.far_squared),
      in_plane(e.in_plane),
      radiance(radiance_number),
      form(e.form),
      two_sided(e.two_sided),
      is_flat(e.form == EmitterForm::Triangle || e.form == EmitterForm::Rectangle) {
    if (e.form == EmitterForm::Rectangle && !e.right_angled) far_squared = -1.0;
}

AreaLanes::AreaLanes() {
    for (std::size_t lane = 0; lane < kMost; ++lane) {
        numbers_.corner[2][lane] = -1.0;
        numbers_.x[0][lane] = numbers_.y[1][lane] = numbers_.normal[2][lane] = 1.0;
        numbers_.area_density[lane] = 2.0;
    }
}

void AreaLanes::set(std::size_t lane, const FlatEmitter& e, const Spectrum& radiance,
                    std::size_t light, double probability) {
    const auto put = [lane](const Vec3& v, double(&values)[3][kMost]) {
        values[0][lane] = v.x;
        values[1][lane] = v.y;
        values[2][lane] = v.z;
    };
    put(e.corner, numbers_.corner);
    put(e.x, numbers_.x);
    put(e.y, numbers_.y);
    put(e.normal, numbers_.normal);
    numbers_.area_density[lane] = e.density;
    numbers_.far_squared[lane] = e.far_squared;
    numbers_.in_plane[lane] = e.in_plane;
    numbers_.probability[lane] = probability;
    for (int k = 0; k < Spectrum::kCount; ++k) numbers_.radiance[k][lane] = radiance[k];
    const std::uint32_t bit = 1u << lane;
    const auto mark = [bit](bool holds, std::uint32_t& lanes) {
        lanes = (lanes & ~bit) | (holds ? bit : 0u);
    };
    mark(e.two_sided, numbers_.two_sided);
    mark(e.form == EmitterForm::Triangle, numbers_.triangles);
    lights_[lane] = light;
}

std::uint32_t AreaLanes::draw(std::uint32_t lanes, const LightCallLanes& calls,
                              LightDrawLanes& results) {
    ALHAZEN_KERNEL(draw_by_area_of_target)(lanes, calls, numbers_, results);
    for_each_lane(numbers_.drawn, [&](std::size_t lane) {
        const bool shines = (numbers_.shining >> lane & 1u) != 0;
        results.places[lane] =
            shines ? PlaceInLight{lights_[lane],
                                  {numbers_.weights[0][lane], numbers_.weights[1][lane]}}
                   : PlaceInLight{};
    });
    return lanes & ~numbers_.drawn;
}

}  // namespace alhazen
#endif
