#pragma once
/// The volumes around a point at which a path begins: an eye under water, a light in glass.
///
/// Conventions: volumes are found by their boundaries along a straight ray from outside to the
/// point. All of them count, also those that other surfaces hide: an opaque face that coincides
/// with a boundary, the opaque wall that a part cuts into a solid, an opaque spot of a texture.
/// Around solids of several media lie the volumes in front of them. An unbounded volume may contain
/// that whole ray; it is found by a second ray from the opposite side. Not found: volumes that
/// contain both rays, and boundaries farther away than 1e8 times the radius of the bounded
/// geometry.

#include "alhazen/renderers/core/tinted_media.h"
#include "alhazen/renderers/volumes/coincident_faces.h"
#include "alhazen/renderers/volumes/medium_stack.h"
#include "alhazen/scene/scene.h"

namespace alhazen {

class MediaFinder {
  public:
    explicit MediaFinder(const Scene& scene);

    /// False if the scene has no volumes.
    [[nodiscard]] bool has_volumes() const { return has_volumes_; }
    [[nodiscard]] MediumStack around(const Vec3& point, float time) const;
    /// The volumes around a point beside the surfaces on which it lies, on the side of the unit
    /// `normal`.
    [[nodiscard]] MediumStack beside(const Vec3& point, const Vec3& normal, float time) const;
    /// The unbounded volumes around the point: only these reach to infinity.
    [[nodiscard]] MediumStack without_end_around(const Vec3& point, float time) const;

  private:
    struct Found {
        MediumStack all, endless;
    };
    class Crossings;

    /// `side`: of `beside`; null: `around`.
    [[nodiscard]] MediumStack found_around(const Vec3& point, const Vec3* side, float time) const;
    /// The volumes by a ray along `direction` that ends at the point.
    [[nodiscard]] Found along(const Vec3& direction, const Vec3& point, const Vec3* side,
                              float time) const;
    /// A distance from the point against `direction` beyond all crossings.
    [[nodiscard]] double way_before_all(const Vec3& direction, const Vec3& point, float time) const;
    [[nodiscard]] bool is_endless(const Hit& hit) const;

    const Scene& scene_;
    CoincidentFaces faces_;  ///< copied for each search
    bool has_volumes_;
    bool reaches_infinity_ = false;
    Vec3 center_;  ///< of a sphere around all bounded geometry
    double radius_ = 1;
};

/// The medium of a ray of Whitted's equation that begins within volumes. Where kt acts by distance,
/// in the bodies of such materials too, the eye is outside of them. `media`: as of medium_behind.
[[nodiscard]] RayMedium medium_within(const Scene& scene, const MediumStack& volumes,
                                      TintedMedia* media);

}  // namespace alhazen
