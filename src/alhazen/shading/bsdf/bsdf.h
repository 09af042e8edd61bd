#pragma once
/// How a point of a surface scatters light: a weighted sum of lobes (lobe.h), each with value,
/// sample, density and albedo in closed form.
///
/// Source: Nicodemus et al., "Geometrical Considerations and Nomenclature for Reflectance", NBS
/// 1977; Veach, "Robust Monte Carlo Methods for Light Transport Simulation", 1997, chapters 3 and 5
/// (BSDFs, and their adjoints where light is refracted).
/// Differs: what lies below a cover loses, of the light to the eye, the share that the cover
/// reflects at the angle of the eye. That keeps energy exactly; it makes the two directions
/// unequal, and importance the adjoint: value(v, l, Radiance) = value(l, v, Importance) for every
/// material. Conventions: directions are unit, away from the surface, in the local frame of the
/// point: z is the shading normal on the side of the view (the z of a view is > 0), x the tangent.
/// `value` has no cosine. Singular lobes (mirrors, smooth glass) are known to `sample` alone.
/// Threads: const functions may be called from many.

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

/// Lobes of a Bsdf: three materials of a glTF surface, blended, have no more.
inline constexpr std::size_t kMaxLobes = 18;
/// A set of covers (bits by their index in the Bsdf).
using CoverSet = std::uint32_t;

/// Light that comes from single directions, as the weights of samples without a choice.
struct SingularLight {
    Spectrum reflected;    ///< share of the light from the mirror direction
    Spectrum transmitted;  ///< of that from the refracted direction; 0 beyond the critical angle
    double eta = 0;        ///< index on the side of the view over that behind; 0: nothing refracts
};

class Bsdf {
  public:
    /// Adds a lobe `weight` times, below `covers`. More than kMaxLobes: the one that matters least
    /// is left out.
    void add(const Spectrum& weight, const Lobe& lobe, CoverSet covers = 0);
    /// A layer over lobes to be added; null set where there is no place for more.
    CoverSet add_cover(const Cover& cover);
    /// All lobes of another, each `weight` times: materials that are blended.
    void add(const Bsdf& other, double weight);

    /// Per steradian, without singular lobes.
    [[nodiscard]] Spectrum value(const Vec3& view, const Vec3& direction,
                                 Transport transport) const;
    /// Share of matt lobes in `value`; 0 where that is black.
    [[nodiscard]] Spectrum diffuse_share(const Vec3& view, const Vec3& direction) const;
    /// With which `sample(view)` gives `direction`, by solid angle, without singular lobes. (A
    /// sample's own density is this.)
    [[nodiscard]] double density(const Vec3& view, const Vec3& direction) const;
    /// `choice` and `u` in [0, 1). Empty where the light is absorbed.
    [[nodiscard]] std::optional<BsdfSample> sample(const Vec3& view, double choice, const Vec2& u,
                                                   Transport transport) const;
    /// Whether `sample` uses `choice`.
    [[nodiscard]] bool chooses() const { return !matt_.is; }
    /// Whether it is a single matt reflection, whose directions are those of `cosine_direction`.
    [[nodiscard]] bool is_only_matt() const { return matt_.is; }
    /// `sample` where it is, for a direction that is drawn.
    [[nodiscard]] std::optional<BsdfSample> sample_matt(const Vec3& view,
                                                        const Vec3& direction) const;
    /// Share of the light from all directions that goes to `view`, or a close approximation.
    [[nodiscard]] Spectrum albedo(const Vec3& view) const;
    /// False: only singular lobes, or none: lights need not be sampled.
    [[nodiscard]] bool has_density() const { return traits_.has_density; }
    /// The reflectance where all that is not singular is one matt reflection; else none.
    [[nodiscard]] std::optional<Spectrum> lambert() const;
    /// Whether light comes back or goes on in single directions.
    [[nodiscard]] bool has_singular() const { return traits_.has_singular; }
    /// What mirrors and smooth glass do with light that goes to `view`, all such lobes together.
    [[nodiscard]] SingularLight singular(const Vec3& view, Transport transport) const;
    /// Whether `value` may be above 0 below the surface.
    [[nodiscard]] bool transmits() const { return traits_.transmits; }
    /// Whether some lobe is a rough boundary between clear media.
    [[nodiscard]] bool has_rough_boundary() const;
    /// Whether all lobes are smooth boundaries between clear media, and there is one.
    [[nodiscard]] bool refracts_alone() const;
    /// Whether some lobe transmits, singular ones too.
    [[nodiscard]] bool lets_through() const { return traits_.lets_through; }
    /// What it does to polarised light from `direction`: by all singular lobes or by all others, as
    /// `value` weighs them for radiance, over the unpolarised light that they give.
    [[nodiscard]] PlaneMueller polarization(const Vec3& view, const Vec3& direction,
                                            bool singular) const;
    /// Share that thin sheets let go straight on: what a shadow ray keeps.
    [[nodiscard]] Spectrum straight(const Vec3& view) const;
    /// With which `sample` goes straight on through a thin sheet.
    [[nodiscard]] double straight_probability(const Vec3& view) const;
    [[nodiscard]] std::size_t lobe_count() const { return parts_.size(); }

  private:
    struct Part {
        Spectrum weight;
        CoverSet covers = 0;
        Lobe lobe;
    };
    /// What some lobe is.
    struct Traits {
        bool has_density = false, has_singular = false, transmits = false, lets_through = false;
    };
    void set_traits();
    /// Whether the only lobe is sure to be chosen for all views.
    [[nodiscard]] bool is_chosen_alone() const;
    /// Of a single matt reflection below no cover, for which nothing is asked of its lobe.
    struct Matt {
        bool is = false;
        bool is_chosen = false;  ///< else all is absorbed
        Spectrum value;  ///< into all directions above the surface; 0 where it is not usable
    };

    /// `value` of the lobes that are matt, or of all.
    [[nodiscard]] Spectrum value(const Vec3& view, const Vec3& direction, Transport transport,
                                 bool only_matt) const;
    /// Probabilities of the parts, for a view.
    struct Choice {
        std::array<double, kMaxLobes> share;
        bool any = false;
    };
    [[nodiscard]] Choice choose(const Vec3& view) const;
    /// What the covers let through to a part.
    [[nodiscard]] double through(CoverSet covers, double cosine) const;
    [[nodiscard]] double density(const Choice& choice, const Vec3& view,
                                 const Vec3& direction) const;

    Traits traits_;
    bool chosen_alone_ = false;
    Matt matt_;
    InlineVector<Unmade<Part>, kMaxLobes> parts_;
    InlineVector<Unmade<Cover>, 9> covers_;
};

/// Where a BSDF is asked for.
struct BsdfPlace {
    /// Index of the medium on the side of the view over that behind, for what has no index of its
    /// own two sides (CSG walls); else 0: by the material's index and `from_inside`.
    double eta = 0;
    bool from_inside = false;  ///< the view is inside the volume that the surface bounds
    /// `eta` of each of four wavelengths, the first of which is that above, where they differ.
    const Spectrum* etas = nullptr;
    /// Of the path.
    const Wavelengths& waves = kColorChannels;
};

/// The BSDF of a material at a point.
[[nodiscard]] Bsdf bsdf_of(const Material& material, std::span<const Texture> textures,
                           const SurfaceLookup& lookup, const BsdfPlace& place);

}  // namespace alhazen
