#pragma once
/// The camera as a receiver of light: connections of points to its lens.
///
/// Source: Veach, "Robust Monte Carlo Methods for Light Transport Simulation", 1997, section 8.3.2
/// and appendix 8.A (importance of a camera).
/// Conventions: film coordinates as in cameras/camera.h. Importance is that of the mean over the
/// whole frame. Parallel cameras receive along one direction.

#include <optional>

#include "alhazen/cameras/eye_rays.h"
#include "alhazen/geometry/motion/transform_motion.h"
#include "alhazen/renderers/core/renderer.h"

namespace alhazen {

/// A connection of a point to the lens.
struct LensConnection {
    Vec3 to_lens;         ///< unit, from the point
    double distance = 0;  ///< to the lens
    Vec2 film;            ///< in [0, 1)
    /// Density of eye rays of the frame at the point, by area perpendicular to the direction. The
    /// contribution of a path is its weight at the point times this.
    double density = 0;
};

class CameraLens {
  public:
    explicit CameraLens(const RenderJob& job);

    /// `u`: random numbers for the point on the lens. Empty if the point is not in the picture.
    [[nodiscard]] std::optional<LensConnection> connect(const Vec3& point, const Vec2& u,
                                                        double time) const;
    /// Density by solid angle of the eye ray along unit `direction`; 0 for parallel cameras, whose
    /// rays have a density by area alone (`parallel_density`).
    [[nodiscard]] double direction_density(const Vec3& direction, double time) const;
    [[nodiscard]] bool is_parallel() const { return parallel_; }
    /// Density of the rays of a parallel camera by area perpendicular to them.
    [[nodiscard]] double parallel_density() const { return parallel_density_; }

  private:
    [[nodiscard]] Affine moved(double time) const;
    /// Film coordinates of `v` = look + (x - 1/2) right + (y - 1/2) up.
    [[nodiscard]] Vec2 film_of(const Vec3& v) const;

    LensRays lens_;
    double focus_ = 0;  ///< distance to the plane of focus; 0: a pinhole
    PicturePlane plane_;
    Vec3 normal_;   ///< unit, of the picture, along the view
    double depth_;  ///< distance of the picture plane from the eye
    double area_;   ///< of the picture in that plane
    std::optional<WideView> wide_;
    bool parallel_ = false;
    double parallel_density_ = 0;
    const TransformMotion* motion_;
    Affine camera_from_world_;
};

}  // namespace alhazen
