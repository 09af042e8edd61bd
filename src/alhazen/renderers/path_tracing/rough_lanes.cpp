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
#include "alhazen/simd/angles-inl.h"
#include "alhazen/simd/lane_vectors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {
namespace rough_lanes {

/// RoughReflection::turned and turned_back.
template <std::size_t N>
HWY_INLINE VectorLanes<N> turned(const RoughLanes::Numbers& n, const VectorLanes<N>& v) {
    using D = Lanes<double, N>;
    const D x = load_lanes<N>(n.axis[0]), y = load_lanes<N>(n.axis[1]);
    return {x * v.x + y * v.y, x * v.y - y * v.x, v.z};
}
template <std::size_t N>
HWY_INLINE VectorLanes<N> turned_back(const RoughLanes::Numbers& n, const VectorLanes<N>& v) {
    using D = Lanes<double, N>;
    const D x = load_lanes<N>(n.axis[0]), y = load_lanes<N>(n.axis[1]);
    return {x * v.x - y * v.y, x * v.y + y * v.x, v.z};
}

/// The functions of Ggx.
template <std::size_t N>
struct GgxLanes {
    using D = Lanes<double, N>;

    D x, y;

    [[nodiscard]] HWY_INLINE D stretched_length(const VectorLanes<N>& v) const {
        return sqrt(x * x * v.x * v.x + y * y * v.y * v.y + v.z * v.z);
    }
    [[nodiscard]] HWY_INLINE D normals(const VectorLanes<N>& m) const {
        const D a = m.x / x, b = m.y / y;
        const D s = a * a + b * b + m.z * m.z;
        return D(1.0) / (D(kPi) * x * y * s * s);
    }
    [[nodiscard]] HWY_INLINE VectorLanes<N> sample_visible(const VectorLanes<N>& v, const D& u0,
                                                           const D& u1) const {
        const D zero(0.0), one(1.0);
        const VectorLanes<N> s = VectorLanes<N>{x * v.x, y * v.y, v.z} / stretched_length(v);
        const SineCosine<N> angle = sine_cosine_after(u0);
        const D z = (one - u1) * (one + s.z) - s.z, rest = one - z * z;
        const D radius = sqrt(select_lanes(zero < rest, rest, zero));
        const VectorLanes<N> h = VectorLanes<N>{radius * angle.cosine, radius * angle.sine, z} + s;
        const VectorLanes<N> facet{x * h.x, y * h.y, select_lanes(h.z < zero, zero, h.z)};
        const LaneMask<double, N> none =
            (abs(h.x) <= zero) & (abs(h.y) <= zero) & (abs(h.z) <= zero);
        const VectorLanes<N> unit = facet / select_lanes(none, one, sqrt(dot(facet, facet)));
        return select_lanes(none, VectorLanes<N>{zero, zero, one}, unit);
    }
};

/// Value, and density by solid angle.
template <std::size_t N>
struct Scattered {
    Lanes<double, N> value[4], density;
};

/// `Bsdf::value` and `Bsdf::density` for directions above the surface; `of_direction`: their
/// single-scattering albedo.
template <std::size_t N>
HWY_INLINE Scattered<N> evaluate(const RoughLanes::Numbers& n, const VectorLanes<N>& view,
                                 const VectorLanes<N>& direction,
                                 const Lanes<double, N>& of_direction) {
    using D = Lanes<double, N>;
    const D zero(0.0), half(0.5), one(1.0), most(std::numeric_limits<double>::max());
    const GgxLanes<N> ggx{load_lanes<N>(n.alpha[0]), load_lanes<N>(n.alpha[1])};
    const D share = load_lanes<N>(n.of_view);
    const VectorLanes<N> v = turned(n, view), l = turned(n, direction);
    const VectorLanes<N> sum = v + l, m = sum / sqrt(dot(sum, sum));
    const D normals = half * ggx.normals(m), stretched = ggx.stretched_length(v);
    const D facet = normals / (v.z * ggx.stretched_length(l) + l.z * stretched);
    const D cosine = dot(v, m);
    // std::clamp.
    const D clamped = select_lanes(cosine < zero, zero, select_lanes(one < cosine, one, cosine));
    const D x = one - clamped, grazing = x * x * x * x * x;
    const D lost = one - load_lanes<N>(n.mean_single);
    const LaneMask<double, N> loses = lost > zero;
    const D matt = (one - share) * (one - of_direction) / (D(kPi) * select_lanes(loses, lost, one));
    const D more = select_lanes(loses, matt, zero);
    Scattered<N> result;
    LaneMask<double, N> finite = more <= more, bright = more < more;
    for (int i = 0; i < 4; ++i) {
        const D f0 = load_lanes<N>(n.f0[i]);
        const D reflectance = f0 + grazing * (load_lanes<N>(n.f90[i]) - f0);
        const D value = facet * reflectance + more * load_lanes<N>(n.several[i]);
        result.value[i] = load_lanes<N>(n.weight[i]) * value;
        finite = finite & (abs(result.value[i]) <= most);
        bright = bright | (result.value[i] > zero);
    }
    const LaneMask<double, N> usable = finite & bright;
    for (D& value : result.value) value = select_lanes(usable, value, zero);
    const D lambert = select_lanes(zero < l.z, l.z, zero) / D(kPi);
    const D density = share * (normals / (v.z + stretched)) + (one - share) * lambert;
    result.density = select_lanes((density > zero) & (density <= most), density, zero);
    return result;
}

/// Samples the next directions.
template <std::size_t N>
HWY_INLINE void sample(const RoughLanes::Numbers& n, VertexLanes& v) {
    using D = Lanes<double, N>;
    const LaneMask<double, N> own = lanes_of_bits<double, N>(n.lanes);
    const D zero(0.0);
    const VectorLanes<N> view = turned(n, load_vectors<N>(v.view));
    const GgxLanes<N> ggx{load_lanes<N>(n.alpha[0]), load_lanes<N>(n.alpha[1])};
    const LaneMask<double, N> by_facet = load_lanes<N>(n.choice) < load_lanes<N>(n.of_view);
    // VertexLanes::scatter has sampled the matt lobe.
    const VectorLanes<N> matt = load_vectors<N>(v.next);
    const VectorLanes<N> m = ggx.sample_visible(view, load_lanes<N>(v.u[0]), load_lanes<N>(v.u[1]));
    const VectorLanes<N> mirrored = D(2.0) * dot(view, m) * m - view;
    const VectorLanes<N> next = select_lanes(by_facet, mirrored, matt);
    v.sampled &= bits_of(next.z > zero) | ~n.lanes;
    store_vectors(select_lanes(own, turned_back(n, next), matt), v.next);
}

template <std::size_t N>
HWY_INLINE void weigh(const RoughLanes::Numbers& n, VertexLanes& v) {
    using D = Lanes<double, N>;
    const LaneMask<double, N> own = lanes_of_bits<double, N>(n.lanes);
    const D zero(0.0), most(std::numeric_limits<double>::max());
    const VectorLanes<N> view = load_vectors<N>(v.view), next = load_vectors<N>(v.next);
    const auto put = [&](const D& of_lane, VertexLanes::Numbers& to) {
        store_lanes(select_lanes(own, of_lane, load_lanes<N>(to)), to);
    };
    if ((v.lit & n.lanes) != 0) {
        const VectorLanes<N> to_light = load_vectors<N>(v.to_light);
        const Scattered<N> light = evaluate(n, view, to_light, load_lanes<N>(n.of_light));
        for (int i = 0; i < 4; ++i) put(to_light.z * light.value[i], v.value[i]);
        put(light.density, v.density);
    }
    const Scattered<N> sampled = evaluate(n, view, next, load_lanes<N>(n.of_next));
    const D scale = abs(next.z) / sampled.density;
    LaneMask<double, N> finite = sampled.density > zero, bright = sampled.density < zero;
    for (int i = 0; i < 4; ++i) {
        const D weight = scale * sampled.value[i];
        finite = finite & (abs(weight) <= most);
        bright = bright | (weight > zero);
        put(weight, v.next_weight[i]);
    }
    put(sampled.density, v.next_density);
    v.sampled &= bits_of(finite & bright) | ~n.lanes;
}

}  // namespace rough_lanes

void sample_rough_of_target(const RoughLanes::Numbers& numbers, VertexLanes& vertices) {
    with_lane_count(numbers.lanes, [&](auto count) HWY_ATTR {
        rough_lanes::sample<decltype(count)::value>(numbers, vertices);
    });
}
void weigh_rough_of_target(const RoughLanes::Numbers& numbers, VertexLanes& vertices) {
    with_lane_count(numbers.lanes, [&](auto count) HWY_ATTR {
        rough_lanes::weigh<decltype(count)::value>(numbers, vertices);
    });
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
    std::optional<AnisotropicAlbedo> anisotropic;
    if (lobe->is_anisotropic()) anisotropic.emplace(lobe->ggx());
    return std::make_unique<const RoughLobe>(
        RoughLobe{lobe->ggx(), lobe->axis(), lobe->mean_single(), lobe->several(), term.f0,
                  term.f90, weight, ggx_albedo_sums(lobe->mean_alpha()), anisotropic});
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
    const auto find_albedos = [&](std::uint32_t lanes, const auto& directions, double* albedo) {
        for (; lanes != 0; lanes &= lanes - 1) {
            const auto lane = static_cast<std::size_t>(std::countr_zero(lanes));
            albedo[lane] = lobes_[lane]->single(
                {directions[0][lane], directions[1][lane], directions[2][lane]});
        }
    };
    find_albedos(n.lanes, v.view, n.of_view);
    find_albedos(n.lanes & v.lit, v.to_light, n.of_light);
    ALHAZEN_KERNEL(sample_rough_of_target)(n, v);
    find_albedos(n.lanes & v.sampled, v.next, n.of_next);
    ALHAZEN_KERNEL(weigh_rough_of_target)(n, v);
    clear();
}

}  // namespace alhazen
#endif
