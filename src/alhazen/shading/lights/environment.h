#pragma once
/// What surrounds a scene, ready to be seen and sampled: one colour, or a picture of all directions
/// with, for a clear sky, the disc of the sun before it.
///
/// Conventions: directions are in world space, unit, and run away from the scene. With `up` the
/// vertical, the front of a picture (its centre) is along -z where up is y, along +y where up is z;
/// in general up x (the x axis made perpendicular to it).
/// Threads: const functions may be called from many.

#include <algorithm>
#include <memory>
#include <optional>

#include "alhazen/imaging/image/rgb.h"
#include "alhazen/math/affine.h"
#include "alhazen/shading/lights/direction_picture.h"
#include "alhazen/shading/lights/environment_settings.h"

namespace alhazen {

/// A disc in the sky of equal radiance.
struct SunDisc {
    Vec3 direction;     ///< unit, towards it
    double cosine = 1;  ///< of its radius
    Rgb radiance;
};

class Environment {
  public:
    /// `up`: where the settings have none. Of kind Picture: the picture is read and has a texel.
    Environment(const EnvironmentSettings& settings, const Vec3& up);

    [[nodiscard]] Rgb radiance(const Vec3& direction) const;
    /// A direction for `u` in [0, 1)^2, as seen from a surface with `normal` towards the viewer;
    /// `both_sides`: light from behind counts, too. Precondition: `shines`.
    [[nodiscard]] Vec3 sample(const Vec3& normal, bool both_sides, const Vec2& u) const;
    /// By solid angle.
    [[nodiscard]] double density(const Vec3& normal, bool both_sides, const Vec3& direction) const;
    /// The same, of light as it is sent out, wherever the surface.
    [[nodiscard]] Vec3 sample(const Vec2& u) const;
    [[nodiscard]] double density(const Vec3& direction) const;

    /// Radiance and density of a direction, at once.
    using Sight = DirectionPicture::Sight;
    [[nodiscard]] Sight sight(const Vec3& normal, bool both_sides, const Vec3& direction) const;
    [[nodiscard]] Sight sight(const Vec3& direction) const;

    /// Whether it has a picture, which `sample` looks up; for these numbers, parts of it are
    /// fetched into the cache: DirectionPicture::fetch_guide, then fetch_texels.
    [[nodiscard]] bool is_looked_up() const { return picture_.has_value(); }
    void fetch_guide(const Vec2& u) const {
        if (u.x >= sun_share_) picture_->fetch_guide(in_sky(u));
    }
    void fetch_texels(const Vec2& u) const {
        if (u.x >= sun_share_) picture_->fetch_texels(in_sky(u));
    }

    /// Over all directions.
    [[nodiscard]] Rgb mean() const;
    [[nodiscard]] bool shines() const { return mean().max() > 0.0; }
    /// Texels of the picture that were no radiances, and are black.
    [[nodiscard]] std::size_t bad_texels() const { return bad_texels_; }
    [[nodiscard]] const std::optional<SunDisc>& sun() const { return sun_; }

  private:
    [[nodiscard]] double sun_solid_angle() const;
    /// The numbers for the picture of those that are not for the sun.
    [[nodiscard]] Vec2 in_sky(const Vec2& u) const {
        return {std::min((u.x - sun_share_) / (1.0 - sun_share_), 0x1.fffffffffffffp-1), u.y};
    }
    [[nodiscard]] bool is_in_sun(const Vec3& direction) const {
        return sun_ && dot(direction, sun_->direction) >= sun_->cosine;
    }
    /// Of the picture, with the sun before it.
    [[nodiscard]] Sight with_sun(const Sight& sky, const Vec3& direction) const;

    Mat3 world_from_picture_;
    Rgb factor_;
    std::optional<DirectionPicture> picture_;  ///< none: `factor_` from everywhere
    std::optional<SunDisc> sun_;
    double sun_share_ = 0;  ///< of the directions
    std::size_t bad_texels_ = 0;
};

}  // namespace alhazen
