#pragma once
/// Touching solids for renderers whose surfaces have an index against the air: a face that is left
/// and one that is entered at the same place are one boundary between the two solids.
///
/// Conventions: faces coincide as in coincident_faces.h. kt that acts at surfaces acts at each.
/// Faces of one material that face the same side are pieces of one surface. Solids of several media
/// are met alone. What lies at the place of thin sheets is met below them (sheet_layer.h).
/// Threads: used by one at a time.

#include <optional>
#include <vector>

#include "alhazen/renderers/core/tinted_media.h"
#include "alhazen/renderers/volumes/coincident_faces.h"

namespace alhazen {

class TouchingFaces final : public SurfaceOptics {
  public:
    /// `media`: of Arrival::medium and BehindSurface::medium.
    TouchingFaces(const Scene& scene, TintedMedia& media);

    /// Completes a point hit by a ray. Of a volume's face and an opaque one that coincide the
    /// opaque one is hit. BehindSurface::medium is set if several faces are crossed.
    void set_media(const Arrival& arrival, ShadingPoint& point) override;
    /// As `set_media` with known faces of volumes, those that are entered sorted (OtherFaces): for
    /// renderers that find surfaces without rays.
    void join(const OtherFaces& others, const Arrival& arrival, ShadingPoint& point);

    /// Refractive index on the side of the ray over that behind, at wavelength `nm`, of the last
    /// point; its BehindSurface::joined must be true.
    [[nodiscard]] double eta_by_wave(double nm) const;

  private:
    class BelowSheets;
    /// The sheets at the place of the point, whose faces were found, as seen by its ray; the point
    /// itself included, if it is one and `own`.
    [[nodiscard]] std::vector<MaterialSample> sheets_at(const ShadingPoint& point,
                                                        const Arrival& arrival, bool own) const;
    /// Lays a completed point below sheets, the uppermost of which comes first. `is_first`: the
    /// point is a sheet, before all of them.
    void lay_below(std::vector<MaterialSample> sheets, bool is_first, ShadingPoint& point) const;
    /// True if a face is crossed together with that of the point.
    [[nodiscard]] bool is_joined(const ShadingPoint& point, const OtherFace& other) const;
    /// True if a face of a material bounds a volume.
    [[nodiscard]] bool is_closed(bool physical, std::uint32_t part) const {
        return physical || tints_events_ || scene_.is_closed(part);
    }
    [[nodiscard]] static std::uint32_t part_of(const OtherFace& face) {
        return static_cast<std::uint32_t>(face.inside.part);
    }
    /// The volumes before and behind the faces; none: air.
    void set_sides(const ShadingPoint& point);
    /// The medium of a ray that passes through all faces from the medium `around`.
    [[nodiscard]] std::uint32_t medium_behind(const ShadingPoint& point, std::uint32_t around);

    const Scene& scene_;
    TintedMedia& media_;
    bool tints_events_;  ///< kt acts at every surface
    CoincidentFaces faces_;
    OtherFaces joined_;
    std::optional<Medium> here_, beyond_;
};

}  // namespace alhazen
