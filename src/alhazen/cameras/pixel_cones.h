#pragma once
/// The cones of pixels.
///
/// Source: Amanatides, "Ray Tracing with Cones", SIGGRAPH 1984, section 2 (the cone of a pixel).
/// Conventions: those of camera.h. A cone has the area of its pixel, measured across the centre
/// line. The width of `central_cone` is the height of the pixel in the middle of the picture;
/// footprints of textures use it.

#include "alhazen/cameras/camera.h"
#include "alhazen/cameras/eye_rays.h"
#include "alhazen/geometry/cones/cone_ray.h"

namespace alhazen {

/// The cone of one of `samples_per_pixel` samples of the middle pixel.
[[nodiscard]] ConeRay central_cone(const Camera& camera, int frame_height, int samples_per_pixel);

class PixelCones {
  public:
    /// `cones_per_pixel` cones share the area of a pixel.
    PixelCones(const Camera& camera, int frame_width, int frame_height, int cones_per_pixel);
    /// The cone around the eye ray through a point of the film.
    [[nodiscard]] ConeRay at(const Vec2& film) const;

  private:
    EyeRays eye_;
    bool from_eye_ = true;
    Vec3 pixel_;  ///< vector of a pixel's area in the picture, along the picture's normal
    double parallel_radius_ = 0;
    std::optional<WideView> wide_;
    double film_ = 0;  ///< a pixel's area on the film of a wide camera
};

}  // namespace alhazen
