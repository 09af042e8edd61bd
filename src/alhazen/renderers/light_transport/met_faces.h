#pragma once
/// The surface that a path meets where faces of several parts coincide (coincident_faces.h): an
/// opaque one, a thin sheet where the boundary only changes the media, which is crossed with it, or
/// a boundary that refracts in place of a smooth sheet.

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
        left_ = Spectrum::all(1);
        if (!is_opaque && faces_.instead()) {
            own_.set(scene_, hit, end.media, end.waves, false, end.bsdfs, &faces_.others());
            if (own_.yields()) {
                other = faces_.instead();
                left_ = own_.yielded();
            }
        }
        if (!other) return other;
        set_shading_point(scene_, faces_.ray(), *other, end.arrival, {.constant = end.constant},
                          met);
        if (!is_opaque) faces_.find(met, end.direction, end.arrival, end.mask);
        return other;
    }
    /// The faces that are crossed with the surface met.
    [[nodiscard]] const OtherFaces& others() const { return faces_.others(); }
    /// What is left of the light of the path where the surface that it hit yielded to another.
    [[nodiscard]] const Spectrum& left() const { return left_; }

  private:
    const Scene& scene_;
    CoincidentFaces faces_;
    ScatterPoint own_;  ///< the surface that was hit
    Spectrum left_ = Spectrum::all(1);
};

}  // namespace alhazen
