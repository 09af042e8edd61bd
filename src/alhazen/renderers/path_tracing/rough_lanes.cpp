#include "alhazen/renderers/path_tracing/rough_lanes.h"

#include "alhazen/simd/dispatch.h"

// Compiles the rest of this file once per target.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "alhazen/renderers/path_tracing/rough_lanes.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// After foreach_target.h.
#include <bit>
#include <limits>

#include "alhazen/math/constants.h"
#include "alhazen/simd/lane_vectors-inl.h"
#include "alhazen/simd/trigonometry-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {
namespace rough_lanes {

/// RoughReflection::turned and turned_back.
HWY_INLINE LaneVectors turned(const RoughLanes::Numbers& n, const LaneVectors& v) {
    const Doubles x = load_lanes(n.axis[0]), y = load_lanes(n.axis[1]);
    return {x * v.x + y * v.y, x * v.y - y * v.x, v.z};
}
HWY_INLINE LaneVectors turned_back(const RoughLanes::Numbers& n, const LaneVectors& v) {
    const Doubles x = load_lanes(n.axis[0]), y = load_lanes(n.axis[1]);
    return {x * v.x - y * v.y, x * v.y + y * v.x, v.z};
}

/// The functions of Ggx.
struct GgxLanes {
    Doubles x, y;

    [[nodiscard]] HWY_INLINE Doubles stretched_length(const LaneVectors& v) const {
        return sqrt(x * x * v.x * v.x + y * y * v.y * v.y + v.z * v.z);
    }
    [[nodiscard]] HWY_INLINE Doubles normals(const LaneVectors& m) const {
        const Doubles a = m.x / x, b = m.y / y;
        const Doubles s = a * a + b * b + m.z * m.z;
        return Doubles(1.0) / (Doubles(kPi) * x * y * s * s);
    }
    [[nodiscard]] HWY_INLINE LaneVectors sample_visible(const LaneVectors& v, const Doubles& u0,
                                                        const Doubles& u1) const {
        const Doubles zero(0.0), one(1.0);
        const LaneVectors s = LaneVectors{x * v.x, y * v.y, v.z} / stretched_length(v);
        const SineCosine angle = sine_cosine_of_lanes(Doubles(2.0 * kPi) * u0);
        const Doubles z = (one - u1) * (one + s.z) - s.z, rest = one - z * z;
        const Doubles radius = sqrt(select_lanes(zero < rest, rest, zero));
        const LaneVectors h = LaneVectors{radius * angle.cosine, radius * angle.sine, z} + s;
        const LaneVectors facet{x * h.x, y * h.y, select_lanes(h.z < zero, zero, h.z)};
        const LaneMask<double> none = (abs(h.x) <= zero) & (abs(h.y) <= zero) & (abs(h.z) <= zero);
        const LaneVectors unit = facet / select_lanes(none, one, sqrt(dot(facet, facet)));
        return select_lanes(none, LaneVectors{zero, zero, one}, unit);
    }
};

/// Value, and density by solid angle.
struct Scattered {
    Doubles value[4], density;
};

/// `Bsdf::value` and `Bsdf::density` for directions above the surface; `of_direction`: their
/// single-scattering albedo.
HWY_INLINE Scattered evaluate(const RoughLanes::Numbers& n, const LaneVectors& view,
                              const LaneVectors& direction, const Doubles& of_direction) {
    const Doubles zero(0.0), half(0.5), one(1.0), most(std::numeric_limits<double>::max());
    const GgxLanes ggx{load_lanes(n.alpha[0]), load_lanes(n.alpha[1])};
    const Doubles share = load_lanes(n.of_view);
    const LaneVectors v = turned(n, view), l = turned(n, direction);
    const LaneVectors sum = v + l, m = sum / sqrt(dot(sum, sum));
    const Doubles normals = half * ggx.normals(m), stretched = ggx.stretched_length(v);
    const Doubles facet = normals / (v.z * ggx.stretched_length(l) + l.z * stretched);
    const Doubles cosine = dot(v, m);
    // std::clamp.
    const Doubles clamped =
        select_lanes(cosine < zero, zero, select_lanes(one < cosine, one, cosine));
    const Doubles x = one - clamped, grazing = x * x * x * x * x;
    const Doubles lost = one - load_lanes(n.mean_single);
    const LaneMask<double> loses = lost > zero;
    const Doubles matt =
        (one - share) * (one - of_direction) / (Doubles(kPi) * select_lanes(loses, lost, one));
    const Doubles more = select_lanes(loses, matt, zero);
    Scattered result;
    LaneMask<double> finite = more <= more, bright = more < more;
    for (int i = 0; i < 4; ++i) {
        const Doubles f0 = load_lanes(n.f0[i]);
        const Doubles reflectance = f0 + grazing * (load_lanes(n.f90[i]) - f0);
        const Doubles value = facet * reflectance + more * load_lanes(n.several[i]);
        result.value[i] = load_lanes(n.weight[i]) * value;
        finite = finite & (abs(result.value[i]) <= most);
        bright = bright | (result.value[i] > zero);
    }
    const LaneMask<double> usable = finite & bright;
    for (Doubles& value : result.value) value = select_lanes(usable, value, zero);
    const Doubles lambert = select_lanes(zero < l.z, l.z, zero) / Doubles(kPi);
    const Doubles density = share * (normals / (v.z + stretched)) + (one - share) * lambert;
    result.density = select_lanes((density > zero) & (density <= most), density, zero);
    return result;
}

/// Samples the next directions.
HWY_INLINE void sample(const RoughLanes::Numbers& n, VertexLanes& v) {
    const LaneMask<double> own = lanes_of_bits<double>(n.lanes);
    const Doubles zero(0.0);
    const LaneVectors view = turned(n, load_vectors(v.view));
    const GgxLanes ggx{load_lanes(n.alpha[0]), load_lanes(n.alpha[1])};
    const LaneMask<double> by_facet = load_lanes(n.choice) < load_lanes(n.of_view);
    // VertexLanes::scatter has sampled the matt lobe.
    const LaneVectors matt = load_vectors(v.next);
    const LaneVectors m = ggx.sample_visible(view, load_lanes(v.u[0]), load_lanes(v.u[1]));
    const LaneVectors mirrored = Doubles(2.0) * dot(view, m) * m - view;
    const LaneVectors next = select_lanes(by_facet, mirrored, matt);
    v.sampled &= bits_of(next.z > zero) | ~n.lanes;
    store_vectors(select_lanes(own, turned_back(n, next), matt), v.next);
}

HWY_INLINE void weigh(const RoughLanes::Numbers& n, VertexLanes& v) {
    const LaneMask<double> own = lanes_of_bits<double>(n.lanes);
    const Doubles zero(0.0), most(std::numeric_limits<double>::max());
    const LaneVectors view = load_vectors(v.view), next = load_vectors(v.next);
    const auto put = [&](const Doubles& of_lane, VertexLanes::Numbers& to) {
        store_lanes(select_lanes(own, of_lane, load_lanes(to)), to);
    };
    if ((v.lit & n.lanes) != 0) {
        const LaneVectors to_light = load_vectors(v.to_light);
        const Scattered light = evaluate(n, view, to_light, load_lanes(n.of_light));
        for (int i = 0; i < 4; ++i) put(to_light.z * light.value[i], v.value[i]);
        put(light.density, v.density);
    }
    const Scattered sampled = evaluate(n, view, next, load_lanes(n.of_next));
    const Doubles scale = abs(next.z) / sampled.density;
    LaneMask<double> finite = sampled.density > zero, bright = sampled.density < zero;
    for (int i = 0; i < 4; ++i) {
        const Doubles weight = scale * sampled.value[i];
        finite = finite & (abs(weight) <= most);
        bright = bright | (weight > zero);
        put(weight, v.next_weight[i]);
    }
    put(sampled.density, v.next_density);
    v.sampled &= bits_of(finite & bright) | ~n.lanes;
}

}  // namespace rough_lanes

void sample_rough_of_target(const RoughLanes::Numbers& numbers, VertexLanes& vertices) {
    rough_lanes::sample(numbers, vertices);
}
void weigh_rough_of_target(const RoughLanes::Numbers& numbers, VertexLanes& vertices) {
    rough_lanes::weigh(numbers, vertices);
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace alhazen {

ALHAZEN_KERNEL_TABLE(sample_rough_of_target);
ALHAZEN_KERNEL_TABLE(weigh_rough_of_target);

std::unique_ptr<const RoughLobe> RoughLobe::of(const Bsdf& bsdf) {
    const auto [lobe, weight] = bsdf.rough_alone();
    if (lobe == nullptr) return nullptr;
    const auto& term = std::get<SchlickTerm>(lobe->fresnel());
    return std::make_unique<const RoughLobe>(
        RoughLobe{lobe->ggx(), lobe->axis(), lobe->mean_single(), lobe->several(), term.f0,
                  term.f90, weight, ggx_albedo_sums(lobe->mean_alpha())});
}

RoughLanes::RoughLanes() {
    // Lanes that were never set have finite results.
    for (std::size_t lane = 0; lane < kMost; ++lane) {
        numbers_.alpha[0][lane] = numbers_.alpha[1][lane] = numbers_.axis[0][lane] = 1.0;
        numbers_.mean_single[lane] = 1.0;
    }
}

void RoughLanes::set(std::size_t lane, const RoughLobe& lobe, double choice) {
    Numbers& n = numbers_;
    n.lanes |= 1u << lane;
    n.choice[lane] = choice;
    if (lobes_[lane] == &lobe) return;
    lobes_[lane] = &lobe;
    n.alpha[0][lane] = lobe.ggx.x;
    n.alpha[1][lane] = lobe.ggx.y;
    n.axis[0][lane] = lobe.axis.x;
    n.axis[1][lane] = lobe.axis.y;
    n.mean_single[lane] = lobe.mean_single;
    for (int i = 0; i < Spectrum::kCount; ++i) {
        n.several[i][lane] = lobe.several[i];
        n.f0[i][lane] = lobe.f0[i];
        n.f90[i][lane] = lobe.f90[i];
        n.weight[i][lane] = lobe.weight[i];
    }
}

void RoughLanes::scatter(VertexLanes& v) {
    Numbers& n = numbers_;
    const auto find_albedos = [&](std::uint32_t lanes, const double* cosine, double* albedo) {
        for (; lanes != 0; lanes &= lanes - 1) {
            const auto lane = static_cast<std::size_t>(std::countr_zero(lanes));
            albedo[lane] = lobes_[lane]->singles.at(cosine[lane]);
        }
    };
    find_albedos(n.lanes, v.view[2], n.of_view);
    find_albedos(n.lanes & v.lit, v.to_light[2], n.of_light);
    ALHAZEN_KERNEL(sample_rough_of_target)(n, v);
    find_albedos(n.lanes & v.sampled, v.next[2], n.of_next);
    ALHAZEN_KERNEL(weigh_rough_of_target)(n, v);
    n.lanes = 0;
}

}  // namespace alhazen
#endif
