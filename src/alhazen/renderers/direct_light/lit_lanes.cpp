#include "alhazen/renderers/direct_light/lit_lanes.h"

#include "alhazen/renderers/core/local_shading.h"
#include "alhazen/simd/dispatch.h"

// Compiles the rest of this file once per target.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "alhazen/renderers/direct_light/lit_lanes.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// After foreach_target.h.
#include "alhazen/renderers/direct_light/light_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {
namespace lit_lanes {

template <std::size_t N>
using Numbers = Lanes<double, N>;

using light_lanes::vectors_of;

template <std::size_t N>
HWY_INLINE VectorLanes<N> products(const VectorLanes<N>& a, const VectorLanes<N>& b) {
    return {a.x * b.x, a.y * b.y, a.z * b.z};
}

/// N lanes from lane `first` on, of which `count` are used.
template <std::size_t N>
class Shader {
  public:
    HWY_INLINE Shader(const ShadingConventions& conventions, std::size_t first, std::size_t count,
                      const LaneSurfaces& surfaces, LitLanes& lanes)
        : conventions_(conventions),
          first_(first),
          count_(count),
          surfaces_(surfaces),
          lanes_(lanes) {}

    HWY_INLINE void run(std::span<const Light* const> lights, bool in_world) {
        direction_ =
            in_world ? load(surfaces_.direction)
                     : gathered([&](std::size_t i) HWY_ATTR { return lanes_.ray[i]->direction; });
        const VectorLanes<N> outward = load(surfaces_.normal);
        const std::uint32_t turned = lanes_.turned >> first_;
        normal_ = turned == 0 ? outward
                              : select_lanes(lanes_of_bits<double, N>(turned), -outward, outward);
        const Numbers<N> along = dot(direction_, normal_), nothing(0.0);
        normal_ = select_lanes(along > nothing, -normal_, normal_);
        VectorLanes<N> sum = color([](const LitMaterial& m) -> const Rgb& { return m.base; });
        const VectorLanes<N> diffuse =
            color([](const LitMaterial& m) -> const Rgb& { return m.sample.diffuse; });
        const std::uint32_t shiny = lanes_.shiny >> first_;
        const VectorLanes<N> point = load(surfaces_.point);
        for (const Light* light : lights) {
            const light_lanes::Arriving<N> a =
                light_lanes::arriving<N>(*light, conventions_.clamp_attenuation, point, count_);
            const Numbers<N> cosine = dot(normal_, a.to_light);
            const LaneMask<double, N> lit = cosine > nothing;
            VectorLanes<N> fraction = cosine * diffuse;
            if (const std::uint32_t set = shiny == 0 ? 0 : shiny & bits_of(lit); set != 0) {
                add_highlights(set, a.to_light, cosine, fraction);
            }
            sum = select_lanes(lit, sum + products(a.intensity, fraction), sum);
        }
        store_lanes(sum.x, lanes_.radiance[0] + first_);
        store_lanes(sum.y, lanes_.radiance[1] + first_);
        store_lanes(sum.z, lanes_.radiance[2] + first_);
    }

  private:
    HWY_INLINE VectorLanes<N> load(const double (&rows)[3][kSurfaceLanes]) const {
        return {load_lanes<N>(rows[0] + first_), load_lanes<N>(rows[1] + first_),
                load_lanes<N>(rows[2] + first_)};
    }
    /// v(lane) of each lane; of the first one where a lane is not used.
    template <class V>
    HWY_INLINE VectorLanes<N> gathered(const V& v) const {
        alignas(64) double rows[3][N];
        for (std::size_t i = 0; i < N; ++i) {
            const auto& from = v(i < count_ ? first_ + i : first_);
            for (int k = 0; k < 3; ++k) rows[k][i] = from[k];
        }
        return load_vectors<N>(rows);
    }
    template <class Color>
    HWY_INLINE VectorLanes<N> color(const Color& of) const {
        if (!lanes_.mixed) return vectors_of<N>(of(*lanes_.material[0]));
        return gathered([&](std::size_t i)
                            HWY_ATTR -> const Rgb& { return of(*lanes_.material[i]); });
    }

    /// As `reflected_fraction`, for the lanes in `set`; `fraction` is matt before.
    HWY_NOINLINE void add_highlights(std::uint32_t set, const VectorLanes<N>& to_light,
                                     const Numbers<N>& cosine, VectorLanes<N>& fraction) const {
        const VectorLanes<N> view = -direction_;
        alignas(64) double fractions[3][N], cosines[N], highlights[N];
        if (conventions_.highlight == ShadingConventions::Highlight::BlinnPhong) {
            const VectorLanes<N> sum = to_light + view;
            store_lanes(dot(normal_, sum / sqrt(dot(sum, sum))), highlights);
        } else {
            const VectorLanes<N> mirrored = (Numbers<N>(2.0) * cosine) * normal_ - to_light;
            store_lanes(dot(mirrored, view), highlights);
        }
        store_vectors(fraction, fractions);
        store_lanes(cosine, cosines);
        for_each_lane(set, [&](std::size_t i) {
            const Rgb matt{fractions[0][i], fractions[1][i], fractions[2][i]};
            const Rgb whole = with_highlight(conventions_, lanes_.material[first_ + i]->sample,
                                             highlights[i], cosines[i], matt);
            for (int k = 0; k < 3; ++k) fractions[k][i] = whole[k];
        });
        fraction = load_vectors<N>(fractions);
    }

    const ShadingConventions& conventions_;
    const std::size_t first_, count_;
    const LaneSurfaces& surfaces_;
    LitLanes& lanes_;
    VectorLanes<N> direction_, normal_;  ///< the normal is turned towards the ray's origin
};

void shade(const ShadingConventions& conventions, std::span<const Light* const> lights,
           std::size_t count, bool in_world, const LaneSurfaces& surfaces, LitLanes& lanes) {
    if (count <= 8) {
        Shader<8>(conventions, 0, count, surfaces, lanes).run(lights, in_world);
        return;
    }
#if HWY_CAP_GE512
    Shader<16>(conventions, 0, count, surfaces, lanes).run(lights, in_world);
#else
    Shader<8>(conventions, 0, 8, surfaces, lanes).run(lights, in_world);
    Shader<8>(conventions, 8, count - 8, surfaces, lanes).run(lights, in_world);
#endif
}

}  // namespace lit_lanes

auto shade_of_target() -> decltype(&lit_lanes::shade) {
    return &lit_lanes::shade;
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace alhazen {

ALHAZEN_KERNEL_TABLE(shade_of_target);

void shade_lanes(const ShadingConventions& conventions, std::span<const Light* const> lights,
                 std::size_t count, bool in_world, const LaneSurfaces& surfaces, LitLanes& lanes) {
    ALHAZEN_KERNEL(shade_of_target)()(conventions, lights, count, in_world, surfaces, lanes);
}

}  // namespace alhazen
#endif
