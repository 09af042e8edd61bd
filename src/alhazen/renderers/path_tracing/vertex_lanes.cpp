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
#include "alhazen/simd/lane_vectors-inl.h"
#include "alhazen/simd/trigonometry-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {
namespace vertex_lanes {

/// Components of ShadingFrame::to_local and to_world.
HWY_INLINE LaneVectors to_local(const LaneVectors& v, const LaneVectors& x, const LaneVectors& y,
                                const LaneVectors& z) {
    return {dot(v, x), dot(v, y), dot(v, z)};
}
HWY_INLINE LaneVectors to_world(const LaneVectors& v, const LaneVectors& x, const LaneVectors& y,
                                const LaneVectors& z) {
    return v.x * x + v.y * y + v.z * z;
}

/// The axis x of ShadingFrame::of.
HWY_INLINE LaneVectors tangent_of(const LaneVectors& normal, const LaneVectors& tangent) {
    const LaneVectors across = tangent - dot(tangent, normal) * normal;
    const Doubles squared = dot(across, across);
    const LaneMask<double> usable =
        (squared > Doubles(1e-12) * dot(tangent, tangent)) & (squared > Doubles(1e-100));
    const LaneVectors x = across / sqrt(select_lanes(usable, squared, Doubles(1.0)));
    if (bits_of(usable) == kAllLanes) return x;
    // `perpendicular`.
    const Doubles one(1.0), sign = copysign(one, normal.z), a = Doubles(-1.0) / (sign + normal.z);
    const LaneVectors any{one + sign * normal.x * normal.x * a, sign * normal.x * normal.y * a,
                          -sign * normal.x};
    return select_lanes(usable, x, any);
}

HWY_INLINE void find_frames(VertexLanes& v) {
    const LaneVectors normal = load_vectors(v.triangles.normal);
    const LaneVectors shading = load_vectors(v.triangles.shading_normal);
    const LaneVectors ray = load_vectors(v.ray);
    const Doubles zero(0.0);
    const LaneMask<double> entering = dot(ray, normal) < zero;
    v.entering = bits_of(entering);
    const LaneVectors geometric = select_lanes(entering, normal, -normal);
    const LaneVectors z = select_lanes(dot(ray, shading) > zero, -shading, shading);
    const LaneVectors x = tangent_of(z, load_vectors(v.triangles.dpdu)), y = cross(z, x);
    store_vectors(geometric, v.geometric);
    store_vectors(x, v.x);
    store_vectors(y, v.y);
    store_vectors(z, v.z);
    store_vectors(to_local(-ray, x, y, z), v.view);
    // LeavingRays.
    const LaneVectors point = load_vectors(v.triangles.point);
    const Doubles margin =
        Doubles(LeavingRays::kErrorsAway) * dot(abs(normal), load_vectors(v.triangles.error));
    const Doubles along = select_lanes(entering, margin, -margin);
    store_vectors(point + along * normal, v.origin);
}

/// cosine_density.
HWY_INLINE Doubles cosine_density(const Doubles& cosine) {
    return select_lanes(cosine > Doubles(0.0), cosine, Doubles(0.0)) / Doubles(kPi);
}

HWY_INLINE void scatter(const LightDraws::Results& lights, VertexLanes& v) {
    const LaneVectors x = load_vectors(v.x), y = load_vectors(v.y), z = load_vectors(v.z);
    const LaneVectors geometric = load_vectors(v.geometric);
    const Doubles zero(0.0), one(1.0);
    const LaneMask<double> seen = load_lanes(v.view[2]) > zero;

    const LaneVectors to_light = load_vectors(lights.to_light);
    const LaneVectors local = to_local(to_light, x, y, z);
    const LaneMask<double> above = (local.z > zero) & (dot(to_light, geometric) > zero);
    v.lit = bits_of(above & seen & (load_lanes(lights.density) > zero));
    store_vectors(local, v.to_light);
    store_lanes(cosine_density(local.z), v.density);

    // cosine_direction.
    const Doubles share = load_lanes(v.u[0]), radius = sqrt(share);
    const SineCosine angle = sine_cosine_of_lanes(Doubles(2.0 * kPi) * load_lanes(v.u[1]));
    const LaneVectors next{radius * angle.cosine, radius * angle.sine, sqrt(one - share)};
    const Doubles density = cosine_density(next.z);
    v.sampled = bits_of(seen);
    store_vectors(next, v.next);
    store_lanes(density, v.next_density);
    const Doubles scale = next.z / density;
    for (int i = 0; i < 4; ++i) {
        const Doubles matt = load_lanes(v.matt[i]);
        store_lanes(local.z * matt, v.value[i]);
        store_lanes(scale * matt, v.next_weight[i]);
    }
}

HWY_INLINE void weigh(const LightDraws::Results& lights, VertexLanes& v) {
    const Doubles zero(0.0), one(1.0);
    const LaneMask<double> lit = lanes_of_bits<double>(v.lit);
    const Doubles density = select_lanes(lit, load_lanes(lights.density), one);
    // power_heuristic; singular lights are found by no other strategy.
    const Doubles ratio = select_lanes(lit, load_lanes(v.density), zero) / density;
    const Doubles sure = one / density, shared = sure * (one / (one + ratio * ratio));
    const Doubles weight = lights.singular == 0
                               ? shared
                               : select_lanes(lanes_of_bits<double>(lights.singular), sure, shared);
    Doubles brightest(0.0);
    for (int i = 0; i < 4; ++i) {
        const Doubles value = select_lanes(lit, load_lanes(v.value[i]), zero);
        const Doubles arriving = value * select_lanes(lit, load_lanes(lights.radiance[i]), zero);
        brightest = max_lanes(brightest, abs(arriving));
        store_lanes(load_lanes(v.throughput[i]) * (weight * arriving), v.light[i]);
    }
    v.lit &= bits_of(brightest > zero);

    const LaneVectors x = load_vectors(v.x), y = load_vectors(v.y), z = load_vectors(v.z);
    const LaneVectors next = load_vectors(v.next), direction = to_world(next, x, y, z);
    store_vectors(direction, v.direction);
    const LaneVectors geometric = load_vectors(v.geometric);
    v.sampled &= bits_of((next.z > zero) & (dot(direction, geometric) > zero));
    for (int i = 0; i < 4; ++i) {
        store_lanes(load_lanes(v.throughput[i]) * load_lanes(v.next_weight[i]), v.throughput[i]);
    }
}

}  // namespace vertex_lanes

void find_frames_of_target(VertexLanes& vertices) {
    vertex_lanes::find_frames(vertices);
}
void scatter_lanes_of_target(const LightDraws::Results& lights, VertexLanes& vertices) {
    vertex_lanes::scatter(lights, vertices);
}
void weigh_lanes_of_target(const LightDraws::Results& lights, VertexLanes& vertices) {
    vertex_lanes::weigh(lights, vertices);
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

void VertexLanes::find_frames() {
    triangles.find_surfaces();
    ALHAZEN_KERNEL(find_frames_of_target)(*this);
}
void VertexLanes::scatter(const LightDraws::Results& lights) {
    ALHAZEN_KERNEL(scatter_lanes_of_target)(lights, *this);
}
void VertexLanes::weigh(const LightDraws::Results& lights) {
    ALHAZEN_KERNEL(weigh_lanes_of_target)(lights, *this);
}

}  // namespace alhazen
#endif
