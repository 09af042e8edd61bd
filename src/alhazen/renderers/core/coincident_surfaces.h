#pragma once
/// The surfaces at the place of one that a ray passes: behind the invisible side of a leaf its
/// other side, behind what a decal leaves open the wall.
///
/// Conventions: rays that leave a surface begin outside its error bound and miss all that lies
/// within; so the rest of a ray does not find these surfaces. Paths that meet the back of a
/// single-sided surface stop there only if they stop at no other surface at its place: light meets
/// the faces of a leaf that the eye sees. Surfaces of one part that face the same side count once:
/// where a ray meets the edge between two triangles it hits both.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "alhazen/primitives/surface.h"
#include "alhazen/scene/scene.h"

namespace alhazen {

/// A hit and its ray.
struct HitAlong {
    Hit hit;
    Ray ray;
};

class CoincidentSurfaces {
  public:
    explicit CoincidentSurfaces(const Scene& scene) : scene_(scene) {}

    /// Distance along the unit direction within which surfaces coincide with the surface.
    [[nodiscard]] static double reach(const ShapeSurface& surface, const Vec3& direction);
    /// The part of a ray along the unit direction within reach of the surface.
    [[nodiscard]] static Ray around(const ShapeSurface& surface, const Vec3& direction);

    /// Finds the surfaces that coincide with `surface`, at the hit of `from`, within the ends of
    /// that ray.
    void find(const Surface& surface, const Hit& hit, const Ray& from, const RayQuery& query);
    /// Forgets all surfaces.
    void clear() {
        hits_.clear();
        next_ = 0;
    }
    /// The hit of the next of them along `ray()`; null: none is left. Valid until the next `find`.
    [[nodiscard]] const Hit* next() { return next_ < hits_.size() ? &hits_[next_++] : nullptr; }
    [[nodiscard]] const Ray& ray() const { return ray_; }
    [[nodiscard]] bool any_left() const { return next_ < hits_.size(); }

  private:
    /// A side of a part at a border of one of its pieces.
    struct Side {
        HitParts parts;
        bool front = false;
        friend bool operator==(const Side&, const Side&) = default;
    };

    /// True if a hit may be on several pieces of its part at once.
    [[nodiscard]] bool is_at_border(const Hit& hit) const;
    /// True if the hit is on a side in `sides_`, which it is then added to.
    [[nodiscard]] bool is_known(const Hit& hit, float time);

    const Scene& scene_;
    Ray ray_;
    std::vector<Hit> hits_;
    std::size_t next_ = 0;
    std::vector<Side> sides_;  ///< met at borders
    Surface other_;
};

}  // namespace alhazen
