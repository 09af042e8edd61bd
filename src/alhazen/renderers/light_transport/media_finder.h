#pragma once
/// The volumes around a point at which a path begins: an eye under water, a lamp in glass.
///
/// Conventions: found by a straight ray from afar to the point, which crosses what bounds volumes.
/// A volume without end may lie around all of that ray; a ray from the other side finds those.
/// What lies all along both ways, or further away than 1e8 times what is bounded, is not found.

#include "alhazen/renderers/light_transport/coincident_faces.h"
#include "alhazen/renderers/light_transport/medium_stack.h"
#include "alhazen/scene/scene.h"

namespace alhazen {

class MediaFinder {
  public:
    explicit MediaFinder(const Scene& scene);

    /// False: the scene has no volumes, and no point lies in one.
    [[nodiscard]] bool has_volumes() const { return has_volumes_; }
    [[nodiscard]] MediumStack around(const Vec3& point, float time) const;
    /// Those without end: no other, closed or open, reaches to a point that is infinitely far away.
    [[nodiscard]] MediumStack without_end_around(const Vec3& point, float time) const;

  private:
    struct Found {
        MediumStack all, endless;
    };

    /// Along a ray that goes to the point.
    [[nodiscard]] Found along(const Vec3& direction, const Vec3& point, float time) const;
    /// How far before the point all crossings lie.
    [[nodiscard]] double way_before_all(const Vec3& direction, const Vec3& point, float time) const;
    [[nodiscard]] bool is_endless(const Hit& hit) const;

    const Scene& scene_;
    CoincidentFaces faces_;  ///< what is known of the scene
    bool has_volumes_;
    bool reaches_infinity_ = false;
    Vec3 center_;  ///< of a sphere around what is bounded
    double radius_ = 1;
};

}  // namespace alhazen
