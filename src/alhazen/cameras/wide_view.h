#pragma once
/// Projections of wide cameras: directions from film coordinates, and film coordinates from
/// directions.
///
/// Source: Snyder, "Map Projections: A Working Manual", USGS Professional Paper 1395, 1987
/// (azimuthal equidistant, azimuthal equal-area, equirectangular); Schneider, Schwalbe and Maas,
/// "Validation of Geometric Models for Fisheye Lenses", ISPRS Journal 64, 2009 (lenses with them).
/// Conventions: film coordinates as in camera.h. Film beyond the image of the direction straight
/// back has that direction, and no solid angle.

#include "alhazen/cameras/camera.h"
#include "alhazen/math/vec.h"

namespace alhazen {

class WideView {
  public:
    explicit WideView(const WideCamera& camera);

    /// The unit direction that a point of the film sees.
    [[nodiscard]] Vec3 direction(double x, double y) const;
    /// The film coordinates of a unit direction; outside [0, 1] if it is not in the picture.
    [[nodiscard]] Vec2 film(const Vec3& direction) const;
    /// The solid angle per unit of film area at a point of the film.
    [[nodiscard]] double solid_angle(double x, double y) const;
    /// Height in radians of a pixel in the middle of a picture that is `frame_height` pixels high.
    [[nodiscard]] double pixel_angle(double frame_height) const;

  private:
    /// Angle from the axis for a distance from the middle of the film, and the inverse. Half the
    /// film's height corresponds to half the angle of its height.
    [[nodiscard]] double angle_at(double distance) const;
    [[nodiscard]] double distance_of(double angle) const;

    WideProjection projection_;
    Vec3 forward_, right_, up_;  ///< orthonormal
    double width_, height_;
    double scale_;  ///< equisolid: factor from distance to the sine of half the angle
};

}  // namespace alhazen
