#pragma once
/// The surroundings of a scene, ready for lookup and sampling: one colour, or a picture of all
/// directions with, for a clear sky, the disc of the sun in front.
///
/// Conventions: directions are in world space, unit, and run away from the scene. With `up` the
/// vertical, the front of a picture (its centre) is along -z where up is y, along +y where up is z;
/// in general up x (the x axis made perpendicular to it).
/// Threads: const functions may be called concurrently.

#include <algorithm>
#include <memory>
#include <optional>
#include <span>

#include "alhazen/imaging/image/rgb.h"
#include "alhazen/math/affine.h"
#include "alhazen/shading/lights/direction_picture.h"
#include "alhazen/shading/lights/environment_settings.h"

namespace alhazen {

/// A disc in the sky of uniform radiance.
struct SunDisc {
    Vec3 direction;     ///< unit, towards the disc's centre
    double cosine = 1;  ///< cosine of the angular radius
    Rgb radiance;
};

class Environment {
  public:
    /// `up` applies if the settings have none. Pictures must have been read and have a texel.
    Environment(const EnvironmentSettings& settings, const Vec3& up);

    [[nodiscard]] Rgb radiance(const Vec3& direction) const;
    /// Samples a direction with `u` in [0, 1)^2 for a surface with `normal` towards the viewer;
    /// `both_sides`: light from behind counts as well. Precondition: `emits`.
    [[nodiscard]] Vec3 sample(const Vec3& normal, bool both_sides, const Vec2& u) const;
    /// Density of that `sample` by solid angle.
    [[nodiscard]] double density(const Vec3& normal, bool both_sides, const Vec3& direction) const;
    /// Samples a direction independently of a surface, for light emission.
    [[nodiscard]] Vec3 sample(const Vec2& u) const;
    [[nodiscard]] double density(const Vec3& direction) const;

    /// Radiance and density of a direction.
    using Sight = DirectionPicture::Sight;
    [[nodiscard]] Sight sight(const Vec3& normal, bool both_sides, const Vec3& direction) const;
    [[nodiscard]] Sight sight(const Vec3& direction) const;

    /// `sample(u)` in the picture, step by step (see DirectionPicture). Precondition of the steps:
    /// `searches(u)`.
    using Search = DirectionPicture::Search;
    [[nodiscard]] bool searches(const Vec2& u) const {
        return picture_.has_value() && u.x >= sun_share_;
    }
    [[nodiscard]] Search begin(const Vec2& u) const { return picture_->begin(in_sky(u)); }
    void approach(const Search& search) const { picture_->approach(search); }
    void find(Search& search) const { picture_->find(search); }
    /// The direction of each search.
    void find_directions(std::span<const Search> searches, Vec3* directions) const;
    [[nodiscard]] bool has_picture() const { return picture_.has_value(); }
    /// `sight` of each direction. Precondition: `has_picture`.
    void find_sights(std::span<const Vec3> directions, Sight* sights) const;

    /// Mean radiance over all directions.
    [[nodiscard]] Rgb mean() const;
    [[nodiscard]] bool emits() const { return mean().max() > 0.0; }
    /// Number of texels that are no valid radiance and were set to black.
    [[nodiscard]] std::size_t bad_texels() const { return bad_texels_; }
    [[nodiscard]] const std::optional<SunDisc>& sun() const { return sun_; }

  private:
    [[nodiscard]] double sun_solid_angle() const;
    /// Maps the part of `u` that does not select the sun to the unit square of the picture.
    [[nodiscard]] Vec2 in_sky(const Vec2& u) const {
        return {std::min((u.x - sun_share_) / (1.0 - sun_share_), 0x1.fffffffffffffp-1), u.y};
    }
    [[nodiscard]] bool is_in_sun(const Vec3& direction) const {
        return sun_ && dot(direction, sun_->direction) >= sun_->cosine;
    }
    /// `sky` of the picture, with the sun in front of it.
    [[nodiscard]] Sight with_sun(const Sight& sky, const Vec3& direction) const;

    Mat3 world_from_picture_;
    Rgb factor_;
    std::optional<DirectionPicture> picture_;  ///< empty: `factor_` in all directions
    std::optional<SunDisc> sun_;
    double sun_share_ = 0;  ///< probability that `sample` selects the sun
    std::size_t bad_texels_ = 0;
};

}  // namespace alhazen
