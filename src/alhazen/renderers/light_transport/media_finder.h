#pragma once
/// The volumes around a point at which a path begins: an eye under water, a lamp in glass.
///
/// Conventions: found by a straight ray from afar to the point, which crosses what bounds volumes.
/// Volumes without end that reach beyond the start of that ray are not found.

#include "alhazen/renderers/light_transport/medium_stack.h"
#include "alhazen/scene/scene.h"

namespace alhazen {

class MediaFinder {
  public:
    explicit MediaFinder(const Scene& scene);

    /// False: the scene has no volumes, and no point lies in one.
    [[nodiscard]] bool has_volumes() const { return has_volumes_; }
    [[nodiscard]] MediumStack around(const Vec3& point, float time) const;

  private:
    const Scene& scene_;
    bool has_volumes_;
    Vec3 center_;  ///< of a sphere around what is bounded
    double radius_ = 1;
};

}  // namespace alhazen
