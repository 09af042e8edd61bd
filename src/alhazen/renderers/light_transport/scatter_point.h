#pragma once
/// A surface point at which a path scatters: its BSDF in world space, and the media on its sides.
///
/// Source: Veach, "Robust Monte Carlo Methods for Light Transport Simulation", 1997, section 5.3
/// (shading normals are not symmetric).
/// Conventions: the view is where the path came from. A direction counts as reflected or
/// transmitted by the geometric normal; where the shading normal disagrees nothing is scattered.
/// Null boundaries, in scenes with volumes that scatter, are those between volumes of the same
/// index: they are passed straight, as thin sheets are.

#include <array>
#include <optional>

#include "alhazen/renderers/core/local_shading.h"
#include "alhazen/renderers/light_transport/bsdf_cache.h"
#include "alhazen/renderers/light_transport/coincident_faces.h"
#include "alhazen/renderers/light_transport/medium_stack.h"
#include "alhazen/renderers/light_transport/shading_frame.h"
#include "alhazen/shading/bsdf/bsdf.h"

namespace alhazen {

struct Scattered {
    Vec3 direction;         ///< unit
    Spectrum weight;        ///< value * |cosine| / density
    double density = 0;     ///< by solid angle; of a singular one its probability
    bool singular = false;  ///< its direction has no density
    bool transmitted = false;
    double eta = 1;         ///< index where it enters over where it came from
    bool straight = false;  ///< through a thin sheet or a null boundary, no scattering
    /// Only light of the hero goes there: Wavelengths::keep_hero is then due.
    bool dispersed = false;
};

class ScatterPoint {
  public:
    /// `media`: around the path before the surface. `both_ways`: `reverse_density` will be asked.
    /// `known`: BSDFs that many points share, valid as long as the point where the cache keeps
    /// them; null: there are none. `others`: faces that coincide
    /// with the surface and are crossed with it; null: none.
    void set(const Scene& scene, const ShadingPoint& point, const MediumStack& media,
             const Wavelengths& waves, bool both_ways = false, BsdfCache* known = nullptr,
             const OtherFaces* others = nullptr);
    /// The volume that a surface bounds.
    [[nodiscard]] static Medium volume_of(const ShadingPoint& point);

    /// Whether the point is that of the hero alone: Wavelengths::keep_hero is due before anything
    /// is asked.
    [[nodiscard]] bool needs_hero() const { return needs_hero_; }

    /// value * |cosine| for light from `direction`; singular lobes apart.
    [[nodiscard]] Spectrum value(const Vec3& direction, Transport transport) const;
    /// Share of matt lobes in `value`.
    [[nodiscard]] Spectrum diffuse_share(const Vec3& direction) const {
        return bsdf().diffuse_share(local_view_, frame_.to_local(direction));
    }
    /// What happens to polarised light from `direction`: by singular lobes, or by the others.
    [[nodiscard]] PlaneMueller polarization(const Vec3& direction, bool singular) const {
        return bsdf().polarization(local_view_, frame_.to_local(direction), singular);
    }
    /// With which `sample` gives `direction`.
    [[nodiscard]] double density(const Vec3& direction) const;
    /// With which a path that came from `direction` would go to the view. Only after `set` with
    /// `both_ways`.
    [[nodiscard]] double reverse_density(const Vec3& direction) const;
    [[nodiscard]] std::optional<Scattered> sample(double choice, const Vec2& u,
                                                  Transport transport) const;
    /// Whether its BSDF is a single matt reflection.
    [[nodiscard]] bool is_matt() const { return bsdf().is_only_matt(); }
    /// `sample` where it is, for a direction of `cosine_direction`.
    [[nodiscard]] std::optional<Scattered> sample_matt(const Vec3& local) const;
    /// Whether `sample` uses `choice`.
    [[nodiscard]] bool chooses() const { return !null_ && bsdf().chooses(); }

    /// Both ways of a smooth boundary between clear media, reflection first, weighed without a
    /// choice; none where one of them is all, at other surfaces, and where it disperses.
    [[nodiscard]] std::optional<std::array<Scattered, 2>> both_ways(Transport transport) const;

    [[nodiscard]] bool is_null_boundary() const { return null_; }
    /// The share of light that goes straight on through a thin sheet or a null boundary.
    [[nodiscard]] Spectrum straight() const {
        return null_ ? bsdf().singular(local_view_, Transport::Radiance).transmitted
                     : bsdf().straight(local_view_);
    }
    /// With which `sample` does that.
    [[nodiscard]] double straight_probability() const {
        return thin_ ? bsdf().straight_probability(local_view_) : 0.0;
    }
    [[nodiscard]] bool has_density() const { return bsdf().has_density(); }
    [[nodiscard]] std::optional<Spectrum> lambert() const { return bsdf().lambert(); }
    [[nodiscard]] bool has_singular() const { return bsdf().has_singular(); }
    [[nodiscard]] bool transmits() const { return bsdf().transmits(); }
    /// What its singular lobes do with light that goes to the view.
    [[nodiscard]] SingularLight singular(Transport transport) const {
        return bsdf().singular(local_view_, transport);
    }
    [[nodiscard]] const Vec3& normal() const { return frame_.z; }
    [[nodiscard]] const Vec3& geometric() const { return geometric_; }
    [[nodiscard]] const Vec3& view() const { return view_; }
    /// Whether an eye in `direction` sees the surface, which may be single-sided.
    [[nodiscard]] bool is_seen_from(const Vec3& direction) const {
        return !one_sided_ || (dot(direction, geometric_) > 0.0) == entering_;
    }
    /// Factor of importance that leaves along `direction` because of shading normals.
    [[nodiscard]] double importance_correction(const Vec3& direction) const;

    /// Whether a volume lies on one of its sides.
    [[nodiscard]] bool bounds_volume() const {
        return media_known_ || (bsdf().lets_through() && !thin_);
    }
    /// The media beyond the surface, for a path that is transmitted.
    void cross(MediumStack& media) const;
    /// The same for one that goes straight on where the surface does not cover.
    void cross_opening(MediumStack& media) const {
        if (bounds_volume()) cross(media);
    }

  private:
    [[nodiscard]] std::optional<Scattered> in_world(const BsdfSample& drawn) const;
    [[nodiscard]] const Bsdf& bsdf() const { return shared_ != nullptr ? *shared_ : own_; }
    /// Sets the BSDF at the point; of blended materials their weighted sum.
    void set_bsdf(const Scene& scene, const Surface& surface, const BsdfPlace& place,
                  BsdfCache* known);
    /// The index on the side of the view over that behind, of each wavelength; 0 where the material
    /// says.
    [[nodiscard]] Spectrum etas(const Scene& scene, const ShadingPoint& point,
                                const MediumStack& media, const Wavelengths& waves) const;
    [[nodiscard]] bool sides_agree(const Vec3& direction, const Vec3& local) const {
        return local.z * dot(direction, geometric_) > 0.0;
    }

    Bsdf own_;
    const Bsdf* shared_ = nullptr;     ///< of a cache that keeps it; null: `own_`
    std::optional<Bsdf> from_behind_;  ///< the same surface as seen from its other side
    ShadingFrame frame_;
    Vec3 geometric_, view_, local_view_;
    Medium inside_;  ///< of the volume that the surface bounds
    OtherFaces others_;
    bool entering_ = true, thin_ = false, one_sided_ = false, needs_hero_ = false;
    bool null_ = false;
    bool media_known_ = false;  ///< a solid tells what is behind
    bool behind_inside_ = false;
};

}  // namespace alhazen
