#pragma once
/// A surface point at which a path scatters: its BSDF in world space and the media on its sides.
///
/// Source: Veach, "Robust Monte Carlo Methods for Light Transport Simulation", 1997, section 5.3
/// (shading normals are not symmetric).
/// Conventions: the view is the direction from which the path came. The geometric normal decides
/// whether a direction is reflected or transmitted; if the shading normal disagrees, nothing is
/// scattered. The normal of a map is turned to a viewer (mapped_normal_seen): light is scattered by
/// that which the eye sees, in whichever direction a path goes, and each density is that of the
/// normal that the path before the point sees. A clear coat with another normal (TiltedCoat) has a
/// frame of its own. In scenes with scattering volumes, and at materials of the index of the air,
/// a boundary between volumes of the same index is a null boundary: it is passed straight, as thin
/// sheets are.

#include <array>
#include <optional>

#include "alhazen/renderers/core/local_shading.h"
#include "alhazen/renderers/light_transport/bsdf_cache.h"
#include "alhazen/renderers/light_transport/shading_frame.h"
#include "alhazen/renderers/light_transport/tilted_coat.h"
#include "alhazen/renderers/volumes/coincident_faces.h"
#include "alhazen/renderers/volumes/medium_stack.h"
#include "alhazen/shading/bsdf/bsdf.h"

namespace alhazen {

struct Scattered {
    Vec3 direction;         ///< unit
    Spectrum weight;        ///< value * |cosine| / density
    double density = 0;     ///< by solid angle; of a singular direction the probability
    bool singular = false;  ///< its direction has no density
    bool transmitted = false;
    double eta = 1;         ///< index on the side of `direction` over that of the view
    bool straight = false;  ///< through a thin sheet or a null boundary; not a scattering
    /// The direction is that of the hero wavelength: call Wavelengths::keep_hero.
    bool dispersed = false;
    /// Singular: paths from both sides follow it; not if the normal of a map was turned to the
    /// view.
    bool mutual = true;
};

class ScatterPoint {
  public:
    /// `media`: around the path before the surface. `both_ways`: enables `reverse_density`.
    /// `known`: shared BSDFs; may be null; if it keeps replaced BSDFs, the point is valid until
    /// `BsdfCache::release`. `others`: faces that coincide with the surface and are crossed with
    /// it; null: none. `sheet`: a smooth one at the place of a boundary that refracts, which
    /// yielded to it; null: none.
    void set(const Scene& scene, const ShadingPoint& point, const MediumStack& media,
             const Wavelengths& waves, bool both_ways = false, BsdfCache* known = nullptr,
             const OtherFaces* others = nullptr, const ScatterPoint* sheet = nullptr);

    /// True if the point is valid for the hero wavelength only: call Wavelengths::keep_hero before
    /// any other function.
    [[nodiscard]] bool needs_hero() const { return needs_hero_; }

    /// BSDF * |cosine| for light from `direction`, without singular lobes.
    [[nodiscard]] Spectrum value(const Vec3& direction, Transport transport) const;
    /// Share of diffuse lobes in `value`.
    [[nodiscard]] Spectrum diffuse_share(const Vec3& direction) const;
    /// The Mueller matrix for light from `direction`, of the singular lobes or of the others.
    [[nodiscard]] PlaneMueller polarization(const Vec3& direction, bool singular) const;
    /// The density of `sample` for `direction`.
    [[nodiscard]] double density(const Vec3& direction) const;
    /// The density with which a path from `direction` would continue to the view. Requires `set`
    /// with `both_ways`.
    [[nodiscard]] double reverse_density(const Vec3& direction) const;
    [[nodiscard]] std::optional<Scattered> sample(double choice, const Vec2& u,
                                                  Transport transport) const;
    /// True if the BSDF is a single diffuse reflection.
    [[nodiscard]] bool is_matt() const { return !coat_ && bsdf().is_only_matt(); }
    /// `sample` for a direction of `cosine_direction`; valid if `is_matt`.
    [[nodiscard]] std::optional<Scattered> sample_matt(const Vec3& local) const;
    /// True if `sample` uses `choice`.
    [[nodiscard]] bool chooses() const { return coat_ || (!null_ && bsdf().chooses()); }

    /// Reflection and refraction, in this order, at a smooth boundary without dispersion, each with
    /// its weight without a random choice; none at other surfaces and if one of the two is missing.
    [[nodiscard]] std::optional<std::array<Scattered, 2>> both_ways(Transport transport) const;

    [[nodiscard]] bool is_null_boundary() const { return null_; }
    /// True if the other kind of surface at the place, thin sheet or boundary, is met instead
    /// (CoincidentFaces::instead): of a boundary that has no other effect than to bound volumes, of
    /// the same index, and of a smooth sheet that does not emit at a boundary that refracts.
    [[nodiscard]] bool yields() const { return yields_; }
    /// The straight transmittance of a thin sheet or a null boundary.
    [[nodiscard]] Spectrum straight() const {
        return null_ ? bsdf().singular(local_view_, Transport::Radiance).transmitted
                     : through() * bsdf().straight(local_view_);
    }
    /// The probability that `sample` passes a thin sheet straight.
    [[nodiscard]] double straight_probability() const {
        return thin_ ? (1.0 - coat_share_) * bsdf().straight_probability(local_view_) : 0.0;
    }
    /// True if paths may pass the surface straight.
    [[nodiscard]] bool may_be_passed() const { return null_ || straight_probability() > 0.0; }
    /// True if no light leaves the surface but its own.
    [[nodiscard]] bool is_black() const {
        return !has_density() && !has_singular() && !may_be_passed();
    }
    [[nodiscard]] bool has_density() const {
        return bsdf().has_density() || (coat_ && coat_->has_density());
    }
    [[nodiscard]] std::optional<Spectrum> lambert() const {
        return coat_ ? std::nullopt : bsdf().lambert();
    }
    [[nodiscard]] bool has_singular() const {
        return bsdf().has_singular() || (coat_ && !coat_->has_density());
    }
    [[nodiscard]] bool transmits() const { return bsdf().transmits(); }
    /// True if light from below the normal may be scattered to the view.
    [[nodiscard]] bool is_lit_from_both_sides() const { return transmits() || coat_; }
    /// The singular lobes for light to the view, without a tilted coat.
    [[nodiscard]] SingularLight singular(Transport transport) const {
        return bsdf().singular(local_view_, transport);
    }
    [[nodiscard]] const Vec3& normal() const { return frame_.z; }
    [[nodiscard]] const Vec3& geometric() const { return geometric_; }
    [[nodiscard]] const Vec3& view() const { return view_; }
    /// True if the surface is visible to an eye in `direction`; false at single-sided backs.
    [[nodiscard]] bool is_seen_from(const Vec3& direction) const {
        return !one_sided_ || (dot(direction, geometric_) > 0.0) == entering_;
    }
    /// Correction factor for importance that leaves along `direction`, due to shading normals.
    [[nodiscard]] double importance_correction(const Vec3& direction) const;
    /// True if the surface bounds a volume.
    [[nodiscard]] bool bounds_volume() const {
        return media_known_ || (bsdf().lets_through() && !thin_);
    }
    /// Changes the media before the surface to those behind it, for a transmitted path.
    void cross(MediumStack& media) const;
    /// As `cross`, for a path that passes an uncovered part of the surface.
    void cross_opening(MediumStack& media) const {
        if (bounds_volume()) cross(media);
    }

  private:
    [[nodiscard]] std::optional<Scattered> in_world(const BsdfSample& drawn) const;
    [[nodiscard]] const Bsdf& bsdf() const { return shared_ != nullptr ? *shared_ : own_; }
    /// Sets the BSDF at the point: shared, copied from the cache or made.
    void set_bsdf(const Scene& scene, const Surface& surface, const BsdfPlace& place,
                  BsdfCache* known);
    /// The index before all faces over that behind them, by wavelength.
    [[nodiscard]] Spectrum eta_of_faces(const Scene& scene, const MediumStack& media,
                                        const Wavelengths& waves) const;
    /// The index on the side of the view over that behind, by wavelength; 0: that of the material.
    [[nodiscard]] Spectrum etas(const Scene& scene, const ShadingPoint& point,
                                const MediumStack& media, const Wavelengths& waves) const;
    using Directions = LocalDirections;
    /// View and direction in the frame of the normal that is seen from `direction`. None: the view
    /// is behind that normal, and nothing is scattered. Requires `map_`.
    [[nodiscard]] std::optional<Directions> seen_from(const Vec3& direction) const;
    /// `seen_from` even where nothing is scattered, with a map or without.
    [[nodiscard]] Directions any_seen_from(const Vec3& direction) const;
    /// Adds the clear coat of the point if its normal is another.
    void set_coat(const Scene& scene, const ShadingPoint& point, const Vec3& tangent);
    /// Share of light that a tilted coat leaves to the layers below, to the view.
    [[nodiscard]] double through() const { return coat_ ? coat_->through() : 1.0; }
    /// `value`, `density`, `reverse_density` and `sample` without a tilted coat.
    [[nodiscard]] Spectrum value_below(const Vec3& direction, Transport transport) const;
    [[nodiscard]] double density_below(const Vec3& direction) const;
    [[nodiscard]] double reverse_density_below(const Vec3& direction) const;
    [[nodiscard]] std::optional<Scattered> sample_below(double choice, const Vec2& u,
                                                        Transport transport) const;
    [[nodiscard]] std::optional<Scattered> sample_coated(double choice, const Vec2& u,
                                                         Transport transport) const;
    /// `value_below` for an eye in `direction`, with the cosine of the view.
    [[nodiscard]] Spectrum value_below_seen_from(const Vec3& direction) const;
    [[nodiscard]] bool sides_agree(const Vec3& direction, const Vec3& local) const {
        return local.z * dot(direction, geometric_) > 0.0;
    }

    /// Tints the light through a thin sheet by the faces at its place.
    void tint_by_faces(const Wavelengths& waves, Bsdf& bsdf) const;
    /// Lays a smooth sheet on the side of the lower index of a boundary, or on an opaque face or a
    /// sheet: light is reflected between the two any number of times, once where one of them
    /// scatters it. A rough boundary is only tinted. `eta`: as of BsdfPlace.
    void lay_below(const ScatterPoint& sheet, double eta, Bsdf& bsdf) const;

    Bsdf own_;
    const Bsdf* shared_ = nullptr;     ///< in a cache that keeps it; null: `own_`
    std::optional<Bsdf> from_behind_;  ///< BSDF from the other side, with `both_ways`
    struct Map {
        Vec3 mapped, shading, tangent;
        bool turned = false;  ///< `frame_` has another normal than the map
    };
    std::optional<Map> map_;
    std::optional<TiltedCoat> coat_;
    double coat_share_ = 0;  ///< probability of sampling `coat_`
    ShadingFrame frame_;
    Vec3 geometric_, view_, local_view_;
    Medium inside_;  ///< of the volume that the surface bounds
    OtherFaces others_;
    bool entering_ = true, thin_ = false, one_sided_ = false, needs_hero_ = false;
    bool only_changes_media_ = false, null_ = false, yields_ = false;
    bool media_known_ = false;  ///< the media are stated by a solid
    bool enters_volume_ = true, is_wall_ = false;
};

}  // namespace alhazen
