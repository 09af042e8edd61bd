#pragma once
/// Projections that no flat picture has: directions of film coordinates, and back.
///
/// Source: Snyder, "Map Projections: A Working Manual", USGS Professional Paper 1395, 1987
/// (azimuthal equidistant, azimuthal equal-area, equirectangular); Schneider, Schwalbe and Maas,
/// "Validation of Geometric Models for Fisheye Lenses", ISPRS Journal 64, 2009 (lenses with them).
/// Conventions: film coordinates as in camera.h. Film beyond the direction straight back shows that
/// direction, and has no solid angle.

#include "alhazen/cameras/camera.h"
#include "alhazen/math/vec.h"

namespace alhazen {

class WideView {
  public:
    explicit WideView(const WideCamera& camera);

    /// Unit.
    [[nodiscard]] Vec3 direction(double x, double y) const;
    /// Where a unit direction is seen; outside of [0, 1] where it is not.
    [[nodiscard]] Vec2 film(const Vec3& direction) const;
    /// Of a unit of film, at a place.
    [[nodiscard]] double solid_angle(double x, double y) const;
    /// Height of a pixel in the middle of a picture of `frame_height` of them, in radians.
    [[nodiscard]] double pixel_angle(double frame_height) const;

  private:
    /// Angle from the axis at a distance of the middle of the film, and back. Distances are such
    /// that half the height of the film is half the angle of its height.
    [[nodiscard]] double angle_at(double distance) const;
    [[nodiscard]] double distance_of(double angle) const;

    WideProjection projection_;
    Vec3 forward_, right_, up_;  ///< orthonormal
    double width_, height_;
    double scale_;  ///< equisolid: of distance to the sine of half the angle
};

}  // namespace alhazen
