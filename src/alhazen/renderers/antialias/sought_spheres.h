#pragma once
/// Objects that no eye ray has met, in a tree of spheres: which rays pass close to them.
///
/// The sphere of level k has the radius max(R, r_k(D)): R bounds the object, D is the distance of
/// its centre from the eye, and r_k(D) half the largest diagonal of a cell of level k, seen from
/// there. The direction of the centre lies in some cell, and the ray through the nearest corner of
/// that cell passes within r_k(D) of the centre. So some ray of level 0 meets the sphere of every
/// object whose centre is in the picture; where its cells are divided, so does some ray of level 1;
/// and so on down to the object.
///
/// Source: Whitted, "An Improved Illumination Model for Shaded Display", CACM 23(6), 1980, section
/// "Treatment of Aliasing" (bounding spheres that are large enough for some ray).
/// Differs: the ray must also meet the object's box, widened by r_k(D), which is tighter around
/// long objects; what lies behind the surface that the ray shows is not looked for; spheres are
/// smaller at each level, so that only the cells around the object are divided.
/// Threads: const functions may be called from many threads.

#include <memory>
#include <span>
#include <vector>

#include "alhazen/renderers/antialias/adaptive_grid.h"
#include "alhazen/renderers/antialias/picture_grid.h"
#include "alhazen/renderers/antialias/scene_objects.h"

namespace alhazen {

class SoughtSpheres final : public ObjectWatch {
  public:
    /// [object] `met`: 1 for those that rays have met, kept up to date by the caller; the arguments
    /// must outlive the object. The tree has the objects that are not met now.
    SoughtSpheres(const std::vector<SceneObject>& objects, const std::vector<std::uint8_t>& met,
                  const PictureGrid& picture);

    [[nodiscard]] bool empty() const { return sought_.empty(); }
    /// The pixels of a crop `width` wide and `height` high that share a corner whose ray passes an
    /// object of the tree. [point] `points`, `distances`: all corners; units of 2^-depth pixels.
    [[nodiscard]] std::vector<WatchedObject> around(std::span<const GridPoint> points, int depth,
                                                    std::span<const double> distances, int width,
                                                    int height) const;

    [[nodiscard]] bool is_sought(std::uint32_t object) const override { return met_[object] == 0; }
    [[nodiscard]] bool passes(std::uint32_t object, int level, GridPoint point,
                              double distance) const override {
        return passes(object, level, picture_.ray(level, point), distance);
    }
    [[nodiscard]] bool is_smaller(std::uint32_t object, int level) const override {
        const BoundingSphere& sphere = objects_[object].sphere;
        return sphere.radius < picture_.least_radius(level, picture_.distance(sphere.center));
    }

  private:
    [[nodiscard]] bool passes(std::uint32_t object, int level, const Ray& ray,
                              double distance) const;
    [[nodiscard]] double radius(const SceneObject& object, int level) const;

    const std::vector<SceneObject>& objects_;
    const std::vector<std::uint8_t>& met_;
    const PictureGrid& picture_;
    std::vector<std::uint32_t> sought_;      ///< [sphere of the tree] object
    std::shared_ptr<const Aggregate> tree_;  ///< over the spheres of level 0
    double t_min_ = 0;                       ///< of queries: -infinity where the eye is in a sphere
};

}  // namespace alhazen
