#pragma once
/// The surface that a path meets where faces of several parts coincide (coincident_faces.h): an
/// opaque one, a thin sheet where the boundary only changes the media, which is crossed with it, or
/// a boundary that refracts, below a smooth sheet. Below a smooth sheet are also met an opaque face
/// that does not shine and another sheet.

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
        has_sheet_ = false;
        const bool is_opaque = faces_.opaque().has_value();
        if (hit.material->thin && (is_opaque || (!faces_.instead() && !faces_.sheets().empty()))) {
            return find_below(hit, end, met);
        }
        std::optional<Hit> other = faces_.opaque();
        if (!is_opaque && faces_.instead()) {
            if (yields(hit, end)) {
                has_sheet_ = hit.material->thin;
                other = faces_.instead();
            } else if (!hit.material->thin) {
                set_shading_point(scene_, faces_.ray(), *faces_.instead(), end.arrival, {}, sheet_);
                if (!is_hit_from_behind(sheet_)) {
                    faces_.find(sheet_, end.direction, end.arrival, end.mask);
                    has_sheet_ = yields(sheet_, end);
                    faces_.find(hit, end.direction, end.arrival, end.mask);
                }
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
    /// The smooth sheet at the place of the boundary met, which refracts; null: none. Valid until
    /// the next `find`.
    [[nodiscard]] const ScatterPoint* sheet() const { return has_sheet_ ? &own_ : nullptr; }

  private:
    /// `find` at a sheet that lies on an opaque face or another sheet.
    [[nodiscard]] std::optional<Hit> find_below(const ShadingPoint& hit, const End& end,
                                                ShadingPoint& met) {
        (void)yields(hit, end);
        const bool shines = !hit.material->emission.is_black() || hit.material->unlit;
        if (own_.has_density() || shines) return {};
        const Hit below = faces_.opaque() ? *faces_.opaque() : faces_.sheets().front();
        const Ray ray = faces_.ray();
        set_shading_point(scene_, ray, below, end.arrival, {}, sheet_);
        if (!sheet_.material->emission.is_black() || sheet_.material->unlit) return {};
        // Sheets are outside of solids.
        has_sheet_ = sheet_.entering || !scene_.is_closed(sheet_.surface.part);
        set_shading_point(scene_, ray, below, end.arrival, {.constant = end.constant}, met);
        return below;
    }
    /// Sets `own_` to a surface whose faces were found; true if it yields.
    [[nodiscard]] bool yields(const ShadingPoint& point, const End& end) {
        own_.set(scene_, point, end.media, end.waves, false, end.bsdfs, &faces_.others());
        return own_.yields();
    }

    const Scene& scene_;
    CoincidentFaces faces_;
    ScatterPoint own_;    ///< a surface that may yield: the one that was hit, or the sheet there
    ShadingPoint sheet_;  ///< at the place of what was hit
    bool has_sheet_ = false;
};

}  // namespace alhazen
