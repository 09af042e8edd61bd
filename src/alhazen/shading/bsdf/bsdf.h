#pragma once
/// How a point of a surface scatters light: a weighted sum of lobes (lobe.h), each with value,
/// sample, density and albedo in closed form.
///
/// Source: Nicodemus et al., "Geometrical Considerations and Nomenclature for Reflectance", NBS
/// 1977; Veach, "Robust Monte Carlo Methods for Light Transport Simulation", 1997, chapters 3 and 5
/// (BSDFs, and their adjoints where light is refracted).
/// Differs: light that leaves through a cover is scaled by the cover's transmittance at the angle
/// of the eye. Energy is conserved exactly, but `value` is not symmetric; importance is the
/// adjoint: value(v, l, Radiance) = value(l, v, Importance) for every material.
/// Conventions: directions are unit and point away from the surface, in the local frame of the
/// point: z is the shading normal on the side of the view (the z of a view is > 0), x the tangent.
/// `value` excludes the cosine. Singular lobes (mirrors, smooth glass) contribute to `sample` only.
/// Threads: const functions may be called concurrently.

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "alhazen/base/inline_vector.h"
#include "alhazen/base/unmade.h"
#include "alhazen/math/vec.h"
#include "alhazen/shading/bsdf/cover.h"
#include "alhazen/shading/bsdf/lobe.h"
#include "alhazen/shading/bsdf/polarization.h"
#include "alhazen/shading/bsdf/transport.h"
#include "alhazen/shading/materials/material.h"
#include "alhazen/shading/spectrum/spectrum.h"
#include "alhazen/shading/spectrum/wavelengths.h"

namespace alhazen {

/// Capacity in lobes; three blended glTF materials have no more.
inline constexpr std::size_t kMaxLobes = 18;
/// A set of covers (bits by their index in the Bsdf).
using CoverSet = std::uint32_t;

/// Light from the mirror and the refracted direction, as the weights of samples without a choice of
/// lobe.
struct SingularLight {
    Spectrum reflected;    ///< share of the light from the mirror direction
    Spectrum transmitted;  ///< share from the refracted direction; 0 beyond the critical angle
    double eta = 0;        ///< index on the side of the view over that behind; 0: no lobe refracts
};

class Bsdf {
  public:
    /// Adds a lobe with `weight`, below `covers`. If there are kMaxLobes already, the lobe of least
    /// importance (weight times albedo at normal incidence) is dropped.
    void add(const Spectrum& weight, const Lobe& lobe, CoverSet covers = 0);
    /// Adds a layer and returns its set, to be passed to `add`; the empty set if its share is 0 or
    /// no capacity is left.
    CoverSet add_cover(const Cover& cover);
    /// Adds all lobes and covers of another BSDF, scaled by `weight`: blended materials.
    void add(const Bsdf& other, double weight);
    /// Multiplies what is reflected and what is transmitted; of rough boundaries both by
    /// `transmitted`.
    void tint(const Spectrum& reflected, const Spectrum& transmitted);

    /// The BSDF value in 1/steradian, without singular lobes.
    [[nodiscard]] Spectrum value(const Vec3& view, const Vec3& direction,
                                 Transport transport) const;
    /// Share of matt lobes in `value`, by channel; 0 where `value` is 0.
    [[nodiscard]] Spectrum diffuse_share(const Vec3& view, const Vec3& direction) const;
    /// Density by solid angle with which `sample(view)` returns `direction`, without singular
    /// lobes; equal to the `density` of the sample.
    [[nodiscard]] double density(const Vec3& view, const Vec3& direction) const;
    /// Samples a direction; `choice` and `u` in [0, 1). Empty if the light is absorbed.
    [[nodiscard]] std::optional<BsdfSample> sample(const Vec3& view, double choice, const Vec2& u,
                                                   Transport transport) const;
    /// True if `sample` uses `choice`.
    [[nodiscard]] bool chooses() const { return !matt_.is; }
    /// True if the BSDF is a single diffuse reflection, sampled by `cosine_direction`.
    [[nodiscard]] bool is_only_matt() const { return matt_.is; }
    /// `sample` for a direction of `cosine_direction`; valid if `is_only_matt`.
    [[nodiscard]] std::optional<BsdfSample> sample_matt(const Vec3& view,
                                                        const Vec3& direction) const;
    /// The lobe and its weight if the BSDF is a single uncovered rough reflection with Schlick's
    /// term, which `sample` takes for every view; else null.
    struct RoughAlone {
        const RoughReflection* lobe = nullptr;
        Spectrum weight;
    };
    [[nodiscard]] RoughAlone rough_alone() const;
    /// Share of the light from all directions that is scattered to `view`, or a close
    /// approximation.
    [[nodiscard]] Spectrum albedo(const Vec3& view) const;
    /// False if all lobes are singular or there are none: light sampling is useless.
    [[nodiscard]] bool has_density() const { return traits_.has_density; }
    /// The reflectance if all lobes that are not singular are uncovered Lambert reflections; else
    /// empty.
    [[nodiscard]] std::optional<Spectrum> lambert() const;
    /// True if some lobe is singular.
    [[nodiscard]] bool has_singular() const { return traits_.has_singular; }
    /// Sum of the mirrors and smooth boundaries for light to `view`.
    [[nodiscard]] SingularLight singular(const Vec3& view, Transport transport) const;
    /// True if `value` may be above 0 below the surface.
    [[nodiscard]] bool transmits() const { return traits_.transmits; }
    /// True if some lobe is a rough boundary between clear media.
    [[nodiscard]] bool has_rough_boundary() const;
    /// True if there are lobes and all are smooth boundaries between clear media.
    [[nodiscard]] bool refracts_alone() const;
    /// True if some lobe, singular or not, transmits.
    [[nodiscard]] bool lets_through() const { return traits_.lets_through; }
    /// Effect on polarised light from `direction`: the sum of all singular lobes or of all others,
    /// weighted as in `value` for radiance, relative to the unpolarised light.
    [[nodiscard]] PlaneMueller polarization(const Vec3& view, const Vec3& direction,
                                            bool singular) const;
    /// Share transmitted straight on by thin sheets: the transmittance for shadow rays.
    [[nodiscard]] Spectrum straight(const Vec3& view) const;
    /// Probability with which `sample` goes straight on through a thin sheet.
    [[nodiscard]] double straight_probability(const Vec3& view) const;
    [[nodiscard]] std::size_t lobe_count() const { return parts_.size(); }

  private:
    struct Part {
        Spectrum weight;
        CoverSet covers = 0;
        Lobe lobe;
    };
    /// The kinds of lobes present.
    struct Traits {
        bool has_density = false, has_singular = false, transmits = false, lets_through = false;
    };
    void set_traits();
    /// True if there is one lobe and it is chosen with probability 1 for every view.
    [[nodiscard]] bool is_chosen_alone() const;
    /// A BSDF of one uncovered Lambert reflection, handled without a visit of its lobe.
    struct Matt {
        bool is = false;
        bool is_chosen = false;  ///< false: all light is absorbed
        Spectrum value;          ///< constant above the surface; 0 where the product is not usable
    };

    /// `value` of all lobes, or of the matt ones only.
    [[nodiscard]] Spectrum value(const Vec3& view, const Vec3& direction, Transport transport,
                                 bool only_matt) const;
    /// Probabilities of the lobes for a view.
    struct Choice {
        std::array<double, kMaxLobes> share;
        bool any = false;
    };
    [[nodiscard]] Choice choose(const Vec3& view) const;
    /// Product of the transmittances of `covers` for this direction.
    [[nodiscard]] double through(CoverSet covers, const Vec3& direction) const;
    [[nodiscard]] double density(const Choice& choice, const Vec3& view,
                                 const Vec3& direction) const;

    Traits traits_;
    bool chosen_alone_ = false;
    Matt matt_;
    InlineVector<Unmade<Part>, kMaxLobes> parts_;
    InlineVector<Unmade<Cover>, 9> covers_;
};

/// The side of the surface and the wavelengths for which a BSDF is made.
struct BsdfPlace {
    /// Index of the medium on the side of the view over that behind, for surfaces between two media
    /// (CSG walls); else 0: given by the material's index and `from_inside`.
    double eta = 0;
    bool from_inside = false;  ///< the view is inside the volume that the surface bounds
    /// The surface's bitangent is along -y of the local frame, not along y: of mirrored
    /// coordinates, or seen from behind, not both.
    bool mirrored = false;
    /// Without the clear coat, which has a normal of its own: `coat_of`.
    bool without_coat = false;
    /// `eta` of each of four wavelengths, the first of which equals `eta`; null if all are equal.
    const Spectrum* etas = nullptr;
    /// The wavelengths of the path.
    const Wavelengths& waves = kColorChannels;
};

/// The BSDF of a material at a point.
[[nodiscard]] Bsdf bsdf_of(const Material& material, std::span<const Texture> textures,
                           const SurfaceLookup& lookup, const BsdfPlace& place);

/// A clear coat by itself: its reflection, and the attenuation of all layers below.
struct CoatLayer {
    Bsdf bsdf;
    Cover cover;
};
/// The coat of a material at a point; empty if there is none.
[[nodiscard]] std::optional<CoatLayer> coat_of(const Material& material,
                                               std::span<const Texture> textures,
                                               const SurfaceLookup& lookup);

}  // namespace alhazen
