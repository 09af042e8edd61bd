#include "alhazen/renderers/path_tracing/vertex_lanes.h"

#include "alhazen/simd/dispatch.h"

// Compiles the rest of this file once per target.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "alhazen/renderers/path_tracing/vertex_lanes.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// After foreach_target.h.
#include "alhazen/math/constants.h"
#include "alhazen/math/vec.h"
#include "alhazen/primitives/surface.h"
#include "alhazen/simd/angles-inl.h"
#include "alhazen/simd/lane_vectors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {
namespace vertex_lanes {

/// Components of ShadingFrame::to_local and to_world.
template <std::size_t N>
HWY_INLINE VectorLanes<N> to_local(const VectorLanes<N>& v, const VectorLanes<N>& x,
                                   const VectorLanes<N>& y, const VectorLanes<N>& z) {
    return {dot(v, x), dot(v, y), dot(v, z)};
}
template <std::size_t N>
HWY_INLINE VectorLanes<N> to_world(const VectorLanes<N>& v, const VectorLanes<N>& x,
                                   const VectorLanes<N>& y, const VectorLanes<N>& z) {
    return v.x * x + v.y * y + v.z * z;
}

/// The axis x of ShadingFrame::of.
template <std::size_t N>
HWY_INLINE VectorLanes<N> tangent_of(const VectorLanes<N>& normal, const VectorLanes<N>& tangent) {
    using D = Lanes<double, N>;
    using Vectors = VectorLanes<N>;
    const Vectors across = tangent - dot(tangent, normal) * normal;
    const D squared = dot(across, across);
    const LaneMask<double, N> usable =
        (squared > D(1e-12) * dot(tangent, tangent)) & (squared > D(1e-100));
    const Vectors x = across / sqrt(select_lanes(usable, squared, D(1.0)));
    if (bits_of(usable) == (1u << N) - 1) return x;
    // `perpendicular`.
    const D one(1.0), sign = copysign(one, normal.z), a = D(-1.0) / (sign + normal.z);
    const Vectors any{one + sign * normal.x * normal.x * a, sign * normal.x * normal.y * a,
                      -sign * normal.x};
    return select_lanes(usable, x, any);
}

template <std::size_t N>
HWY_INLINE void find_frames(VertexLanes& v, LightCallLanes& lights) {
    using D = Lanes<double, N>;
    using Vectors = VectorLanes<N>;
    const Vectors normal = load_vectors<N>(v.triangles.normal);
    const Vectors shading = load_vectors<N>(v.triangles.shading_normal);
    const Vectors ray = load_vectors<N>(v.ray);
    const D zero(0.0);
    const LaneMask<double, N> entering = dot(ray, normal) < zero;
    v.entering = bits_of(entering);
    const Vectors geometric = select_lanes(entering, normal, -normal);
    const Vectors z = select_lanes(dot(ray, shading) > zero, -shading, shading);
    const Vectors x = tangent_of(z, load_vectors<N>(v.triangles.dpdu)), y = cross(z, x);
    store_vectors(geometric, v.geometric);
    store_vectors(x, v.x);
    store_vectors(y, v.y);
    store_vectors(z, v.z);
    store_vectors(to_local(-ray, x, y, z), v.view);
    store_vectors(z, lights.at.normal);
    // LeavingRays.
    const Vectors point = load_vectors<N>(v.triangles.point);
    const Vectors error = load_vectors<N>(v.triangles.error);
    const D least = D(LeavingRays::kLeastPart) * max_lanes(max_lanes(error.x, error.y), error.z);
    const D margin = D(LeavingRays::kErrorsAway) * max_lanes(dot(abs(normal), error), least);
    const D along = select_lanes(entering, margin, -margin);
    store_vectors(point + along * normal, v.origin);
    store_vectors(point, lights.at.point);
    lights.at.both_sides = lights.at.in_volume = 0;
}

/// cosine_density.
template <std::size_t N>
HWY_INLINE Lanes<double, N> cosine_density(const Lanes<double, N>& cosine) {
    using D = Lanes<double, N>;
    return select_lanes(cosine > D(0.0), cosine, D(0.0)) / D(kPi);
}

template <std::size_t N>
HWY_INLINE void scatter(const LightDrawLanes& lights, VertexLanes& v) {
    using D = Lanes<double, N>;
    using Vectors = VectorLanes<N>;
    const Vectors x = load_vectors<N>(v.x), y = load_vectors<N>(v.y), z = load_vectors<N>(v.z);
    const Vectors geometric = load_vectors<N>(v.geometric);
    const D zero(0.0), one(1.0);
    const LaneMask<double, N> seen = load_lanes<N>(v.view[2]) > zero;

    const Vectors to_light = load_vectors<N>(lights.to_light);
    const Vectors local = to_local(to_light, x, y, z);
    const LaneMask<double, N> above = (local.z > zero) & (dot(to_light, geometric) > zero);
    v.lit = v.used & bits_of(above & seen & (load_lanes<N>(lights.density) > zero));
    store_vectors(local, v.to_light);
    store_lanes(cosine_density(local.z), v.density);

    // cosine_direction.
    const D share = load_lanes<N>(v.u[0]), radius = sqrt(share);
    const SineCosine<N> angle = sine_cosine_after(load_lanes<N>(v.u[1]));
    const Vectors next{radius * angle.cosine, radius * angle.sine, sqrt(one - share)};
    const D density = cosine_density(next.z);
    v.sampled = v.used & bits_of(seen);
    store_vectors(next, v.next);
    store_lanes(density, v.next_density);
    const D scale = next.z / density;
    for (int i = 0; i < 4; ++i) {
        const D matt = load_lanes<N>(v.matt[i]);
        store_lanes(local.z * matt, v.value[i]);
        store_lanes(scale * matt, v.next_weight[i]);
    }
}

template <std::size_t N>
HWY_INLINE void weigh(const LightDrawLanes& lights, VertexLanes& v) {
    using D = Lanes<double, N>;
    using Vectors = VectorLanes<N>;
    const D zero(0.0), one(1.0);
    const LaneMask<double, N> lit = lanes_of_bits<double, N>(v.lit);
    const D density = select_lanes(lit, load_lanes<N>(lights.density), one);
    // DirectLightWeights; singular lights are found by no other strategy.
    const std::uint32_t alone = v.shadow_rays_alone ? v.lit : lights.singular;
    const D ratio = select_lanes(lit, load_lanes<N>(v.density), zero) / density;
    const D sure = one / density, shared = sure * (one / (one + ratio * ratio));
    const D weight =
        alone == 0 ? shared : select_lanes(lanes_of_bits<double, N>(alone), sure, shared);
    D brightest(0.0);
    for (int i = 0; i < 4; ++i) {
        const D value = select_lanes(lit, load_lanes<N>(v.value[i]), zero);
        const D arriving = value * select_lanes(lit, load_lanes<N>(lights.radiance[i]), zero);
        brightest = max_lanes(brightest, abs(arriving));
        store_lanes(load_lanes<N>(v.throughput[i]) * (weight * arriving), v.light[i]);
    }
    v.lit &= bits_of(brightest > zero);

    const Vectors x = load_vectors<N>(v.x), y = load_vectors<N>(v.y), z = load_vectors<N>(v.z);
    const Vectors next = load_vectors<N>(v.next), direction = to_world(next, x, y, z);
    store_vectors(direction, v.direction);
    const Vectors geometric = load_vectors<N>(v.geometric);
    v.sampled &= bits_of((next.z > zero) & (dot(direction, geometric) > zero));
    for (int i = 0; i < 4; ++i) {
        store_lanes(load_lanes<N>(v.throughput[i]) * load_lanes<N>(v.next_weight[i]),
                    v.throughput[i]);
    }
}

}  // namespace vertex_lanes

void find_frames_of_target(VertexLanes& vertices, LightCallLanes& lights) {
    with_lane_count(vertices.used, [&](auto count) HWY_ATTR {
        vertex_lanes::find_frames<decltype(count)::value>(vertices, lights);
    });
}
void scatter_lanes_of_target(const LightDrawLanes& lights, VertexLanes& vertices) {
    with_lane_count(vertices.used, [&](auto count) HWY_ATTR {
        vertex_lanes::scatter<decltype(count)::value>(lights, vertices);
    });
}
void weigh_lanes_of_target(const LightDrawLanes& lights, VertexLanes& vertices) {
    with_lane_count(vertices.used, [&](auto count) HWY_ATTR {
        vertex_lanes::weigh<decltype(count)::value>(lights, vertices);
    });
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace alhazen {

ALHAZEN_KERNEL_TABLE(find_frames_of_target);
ALHAZEN_KERNEL_TABLE(scatter_lanes_of_target);
ALHAZEN_KERNEL_TABLE(weigh_lanes_of_target);

VertexLanes::VertexLanes() {
    for (std::size_t lane = 0; lane < kMost; ++lane) ray[2][lane] = -1.0;
}

void VertexLanes::find_frames(std::size_t count, LightCallLanes& lights) {
    used = (1u << count) - 1;
    triangles.find_surfaces(count);
    ALHAZEN_KERNEL(find_frames_of_target)(*this, lights);
}
void VertexLanes::scatter(const LightDrawLanes& lights) {
    ALHAZEN_KERNEL(scatter_lanes_of_target)(lights, *this);
}
void VertexLanes::weigh(const LightDrawLanes& lights) {
    ALHAZEN_KERNEL(weigh_lanes_of_target)(lights, *this);
}

}  // namespace alhazen
#endif
