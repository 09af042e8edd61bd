#pragma once
/// The cones of pixels.
///
/// Source: Amanatides, "Ray Tracing with Cones", SIGGRAPH 1984, section 2 (the cone of a pixel).
/// Conventions: those of the cameras. A cone has the area of its pixel, measured across the centre
/// line; `central_cone` is as wide as the pixel in the middle of the picture is high, which is what
/// footprints of textures go by.

#include "alhazen/cameras/camera.h"
#include "alhazen/cameras/eye_rays.h"
#include "alhazen/geometry/cones/cone_ray.h"

namespace alhazen {

/// Of one of `samples_per_pixel` samples of a pixel.
[[nodiscard]] ConeRay central_cone(const Camera& camera, int frame_height, int samples_per_pixel);

class PixelCones {
  public:
    /// `cones_per_pixel` share the area of a pixel.
    PixelCones(const Camera& camera, int frame_width, int frame_height, int cones_per_pixel);
    /// Around the eye ray through a point of the film.
    [[nodiscard]] ConeRay at(const Vec2& film) const;

  private:
    EyeRays eye_;
    bool from_eye_ = true;
    Vec3 pixel_;  ///< its area in the picture, along the picture's normal
    double parallel_radius_ = 0;
    std::optional<WideView> wide_;
    double film_ = 0;  ///< its area on the film, where that is wide
};

}  // namespace alhazen
