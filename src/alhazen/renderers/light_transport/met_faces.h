#pragma once
/// The surface that a path meets where faces of several parts coincide (coincident_faces.h): an
/// opaque one, or a thin sheet where the boundary only changes the media, which is crossed with it.

#include <optional>

#include "alhazen/renderers/light_transport/scatter_point.h"
#include "alhazen/renderers/volumes/coincident_faces.h"

namespace alhazen {

class MetFaces {
  public:
    explicit MetFaces(const Scene& scene) : scene_(scene), faces_(scene) {}

    /// The end of a path at a surface.
    struct End {
        const Vec3& direction;  ///< unit, of the path
        const Arrival& arrival;
        RayMask mask;
        const MediumStack& media;  ///< before the surface
        const Wavelengths& waves;
        BsdfCache* bsdfs = nullptr;
        MaterialCache* constant = nullptr;
    };
    /// Finds the faces at the place of the surface `hit` that a ray hit. If another one is met, its
    /// hit is returned, and `met`, which may be `hit`, becomes its point.
    [[nodiscard]] std::optional<Hit> find(const ShadingPoint& hit, const End& end,
                                          ShadingPoint& met) {
        faces_.find(hit, end.direction, end.arrival, end.mask);
        const bool is_opaque = faces_.opaque().has_value();
        std::optional<Hit> other = faces_.opaque();
        if (!is_opaque && faces_.sheet()) {
            boundary_.set(scene_, hit, end.media, end.waves, false, end.bsdfs, &faces_.others());
            if (boundary_.only_changes_media()) other = faces_.sheet();
        }
        if (!other) return other;
        set_shading_point(scene_, faces_.ray(), *other, end.arrival, {.constant = end.constant},
                          met);
        if (!is_opaque) faces_.find(met, end.direction, end.arrival, end.mask);
        return other;
    }
    /// The faces that are crossed with the surface met.
    [[nodiscard]] const OtherFaces& others() const { return faces_.others(); }

  private:
    const Scene& scene_;
    CoincidentFaces faces_;
    ScatterPoint boundary_;
};

}  // namespace alhazen
