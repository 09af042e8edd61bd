#pragma once
/// A tree of spheres around the objects that no eye ray has hit; finds the rays that pass close to
/// them.
///
/// A part of an object that lies within a cell of level k, at a distance D from the eye, is within
/// r_k(D) of the ray through the middle of the cell: half the largest diagonal of a cell of that
/// level, seen from there. So that ray meets the sphere of radius R + r_k around the object, where
/// R bounds it, and the rays through all four corners meet the sphere of radius R + 2 r_k. An
/// object may hide in a cell if this holds and some corner shows a surface behind it; with
/// `behind_all` regardless of the corners.
///
/// Source: Whitted, "An Improved Illumination Model for Shaded Display", CACM 23(6), 1980, section
/// "Treatment of Aliasing" (bounding spheres that are large enough for some ray).
/// Differs: of the cells that share a ray through the large sphere only those are divided that may
/// contain a part of the object, by the smaller sphere. The ray through the middle must also meet
/// the object's box and slabs, enlarged by r_k, which are tighter for elongated objects; and the
/// spheres shrink with each level, so that only the cells around the object are divided.
/// Threads: const functions may be called concurrently.

#include <memory>
#include <span>
#include <vector>

#include "alhazen/renderers/antialias/adaptive_grid.h"
#include "alhazen/renderers/antialias/picture_grid.h"
#include "alhazen/renderers/antialias/scene_objects.h"

namespace alhazen {

class SearchSpheres final : public ObjectWatch {
  public:
    /// [object] `met`: 1 for objects that shaded rays have hit, updated by the caller. The
    /// arguments must outlive the object. The tree contains the objects that are not hit at
    /// construction.
    SearchSpheres(const std::vector<SceneObject>& objects, const std::vector<std::uint8_t>& met,
                  const PictureGrid& picture, bool behind_all);

    [[nodiscard]] bool empty() const { return sought_.empty(); }
    /// The pixels in which objects of the tree may hide; sorted. `grid`: in its first round, with
    /// the distances of all corners.
    [[nodiscard]] std::vector<WatchedObject> around(const AdaptiveGrid& grid) const;

    [[nodiscard]] bool is_sought(std::uint32_t object) const override { return met_[object] == 0; }
    [[nodiscard]] bool may_hide(std::uint32_t object, int level, GridPoint cell,
                                double farthest) const override;
    [[nodiscard]] bool is_smaller(std::uint32_t object, int level) const override {
        const BoundingSphere& sphere = objects_[object].sphere;
        return sphere.radius < picture_.least_radius(level, picture_.distance(sphere.center));
    }

  private:
    /// Distance up to which objects are sought if the farthest surface at a corner is at
    /// `farthest`.
    [[nodiscard]] double reach(double farthest) const { return behind_all_ ? kInfinity : farthest; }
    /// r_k at the farthest point of an object.
    [[nodiscard]] double margin(const SceneObject& object, int level) const;

    const std::vector<SceneObject>& objects_;
    const std::vector<std::uint8_t>& met_;
    const PictureGrid& picture_;
    bool behind_all_;
    std::vector<std::uint32_t> sought_;      ///< [sphere of the tree] object
    std::shared_ptr<const Aggregate> tree_;  ///< over the spheres of level 0
    double t_min_ = 0;                       ///< -infinity if the eye is in a sphere
};

}  // namespace alhazen
