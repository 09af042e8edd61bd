#pragma once
/// Fresnel's equations and Beer's law for the rays of Whitted's equation, in place of its
/// coefficients kr and kt; and the nested volumes around these rays.
///
/// Source: Born and Wolf, "Principles of Optics", 7th edition, 1999, section 1.5.2 (fresnel.h);
/// Beer, "Bestimmung der Absorption des rothen Lichts in farbigen Fluessigkeiten", 1852; Whitted,
/// "An Improved Illumination Model for Shaded Display", 1980 (what they replace).
/// Differs: light is unpolarised before every surface. Shadow rays pass boundaries without bending;
/// the reflectance is that at the ray's angle on the side of lower index. The transmittance of two
/// parallel faces is correct, the position of the light behind them is not.
/// Conventions: a medium is a number: 0 is outside all volumes, others identify a volume and the
/// medium around it. Volumes may be left in any order: they are identified by the part that bounds
/// them, else by its material. A solid of several media is one volume, whose medium changes at its
/// walls. Faces that coincide (coincident_faces.h) are one boundary; kt that acts at surfaces acts
/// at each. Threads: used by one at a time.

#include <cstdint>
#include <optional>
#include <vector>

#include "alhazen/renderers/core/ray_medium.h"
#include "alhazen/renderers/volumes/coincident_faces.h"

namespace alhazen {

/// Settings of a renderer that override the optics of the scene; empty: as in the scene.
struct OpticsSettings {
    std::optional<bool> fresnel, beer;
    void adjust(Optics& optics) const {
        optics.fresnel = fresnel.value_or(optics.fresnel);
        optics.beer = beer.value_or(optics.beer);
    }
};

class ExactOptics final : public SurfaceOptics {
  public:
    static constexpr std::uint32_t kOutside = 0;

    ExactOptics(const Scene& scene, const Optics& optics);

    /// `release(mark)` removes all media created since `mark()` returned `mark`.
    [[nodiscard]] std::size_t mark() const { return media_.size(); }
    void release(std::size_t mark) { media_.resize(mark); }

    /// Absorption per unit length: transmittance is exp(-absorption * length).
    [[nodiscard]] const Rgb& absorption(std::uint32_t medium) const {
        return media_[medium].absorption;
    }

    /// The medium inside volumes around a point, at which a ray begins: those of kt by distance
    /// have that at texture coordinates 0.
    [[nodiscard]] RayMedium within(const MediumStack& volumes);

    /// Completes a point hit by a ray: its reflection, its transmission and the medium behind it.
    /// Of a volume's face and an opaque one that coincide the opaque one is hit.
    void set_media(const Arrival& arrival, ShadingPoint& point) override;

    /// Hides the volume that the surface bounds, if it is part of the medium, from shadow rays.
    void hide(std::uint32_t medium, const Surface& surface);
    /// The medium without hidden volumes.
    [[nodiscard]] std::uint32_t seen_by_shadow_rays(std::uint32_t medium);

    /// Refractive index on the side of a ray in medium `around` over that behind, at wavelength
    /// `nm`. `point` must have been completed by `set_media`.
    [[nodiscard]] double eta_by_wave(std::uint32_t around, const ShadingPoint& point,
                                     double nm) const;

    /// The effect of a surface on a ray that passes it straight.
    struct Straight {
        Rgb through;                      ///< transmittance
        std::uint32_t behind = kOutside;  ///< medium
    };
    /// `others`: the faces that coincide with it.
    [[nodiscard]] Straight cross(const Surface& surface, const MaterialSample& material,
                                 const Vec3& direction, std::uint32_t around,
                                 const OtherFaces& others);
    /// The faces that coincide with the surface at a crossing of a shadow ray.
    [[nodiscard]] const OtherFaces& faces_at(const Ray& ray, const Hit& crossing, float time);

  private:
    struct Medium {
        std::uint64_t part = 0;      ///< that bounds it (volume_number)
        std::uint32_t material = 0;  ///< of it
        std::uint32_t around = kOutside;
        bool hidden = false;  ///< from shadow rays
        double index = 1;
        Rgb absorption;
    };
    /// The two sides of a surface along a ray.
    struct Sides {
        double here = 1, beyond = 1;  ///< indices
        std::uint32_t behind = kOutside;
        bool joined = false;  ///< of several faces, or within another volume
        Rgb before{1, 1, 1};  ///< at a wall: tint of the medium that is left; of other faces
    };

    [[nodiscard]] Sides sides_of(const Surface& surface, const MaterialSample& material,
                                 bool entering, std::uint32_t around, const OtherFaces& others);
    /// A thin sheet at the place of a surface; its sample is as evaluated, not turned to a ray.
    struct Sheet {
        Surface surface;
        MaterialSample sample;
    };
    class MetInstead;
    /// `instead`: of another surface at its place, which the point does not yield to.
    void set_media(const Arrival& arrival, ShadingPoint& point, const MetInstead* instead);
    /// ScatterPoint::yields. `sides`: of the surface.
    [[nodiscard]] bool yields(const ShadingPoint& point, std::uint32_t around, const Sides& sides);
    /// The sheets at the place of the point as a ray hits them, whose faces were found; the point
    /// itself included, if it is one.
    [[nodiscard]] std::vector<Sheet> sheets_at(const ShadingPoint& point,
                                               const Arrival& arrival) const;
    [[nodiscard]] std::vector<Sheet> other_sheets(const ShadingPoint& point,
                                                  const Arrival& arrival) const;
    /// Lays the point below sheets, the uppermost of which comes first. `is_first`: the point is a
    /// sheet, before all of them.
    void lay_below(std::vector<Sheet> sheets, bool is_first, const Arrival& arrival,
                   const Sides& sides, ShadingPoint& point) const;
    void lay_below(const Sheet& sheet, bool is_first, const Arrival& arrival, const Sides& sides,
                   ShadingPoint& point) const;
    /// A face that a ray crosses.
    struct Face {
        Medium inside;  ///< of a wall behind it
        bool entering = true, wall = false;
        bool known = false;  ///< of a solid of several media
        double index = 1;    ///< of the volume before the face, if that is left
        Rgb tint{1, 1, 1};   ///< of the medium before a wall
    };
    [[nodiscard]] Face face_of(const Surface& surface, const MaterialSample& material,
                               bool entering) const;
    /// The sides of faces that are crossed at once. `own`: that was hit; null: a thin sheet was.
    [[nodiscard]] Sides sides_of_all(const Face* own, std::uint32_t around,
                                     const OtherFaces& others);
    [[nodiscard]] Medium medium_of(const Surface& surface, const MaterialSample& sample) const;
    [[nodiscard]] Medium medium_of(const OtherFace& face) const;
    std::uint32_t enter(Medium medium, std::uint32_t around);
    /// The volume of that part, else of that material, or of that part alone; kOutside: none.
    [[nodiscard]] std::uint32_t place_of(const Medium& volume, std::uint32_t around) const;
    [[nodiscard]] std::uint32_t of_part(const Medium& volume, std::uint32_t around) const;
    /// The medium after `volume` has been left.
    [[nodiscard]] std::uint32_t without(const Medium& volume, std::uint32_t around);
    /// The medium after the volume of that part has got that medium; it is entered if it was not.
    [[nodiscard]] std::uint32_t changed(const Medium& medium, std::uint32_t around);
    std::uint32_t replace(std::uint32_t old, const Medium& medium, std::uint32_t around);
    std::uint32_t remove(std::uint32_t left, std::uint32_t around);
    /// True if a face of Whitted's materials has no inside.
    [[nodiscard]] bool is_open(bool physical, std::uint32_t part) const {
        return !physical && !tints_events_ && !optics_.beer && !scene_.is_closed(part);
    }
    [[nodiscard]] Rgb tint_of(const MaterialSample& sample) const;
    /// Turns a physical sample to a ray; with `fresnel` each of blended materials by itself.
    void turn(const Surface& surface, const SurfaceLookup& lookup, double cosine, double here,
              double beyond, MaterialSample& sample) const;
    void turn(const Material& material, const SurfaceLookup& lookup, double cosine, double here,
              double beyond, MaterialSample& sample) const;
    /// `dielectric`: its share of the reflection.
    void turn(double dielectric, double cosine, double here, double beyond,
              MaterialSample& sample) const;

    const Scene& scene_;
    Optics optics_;
    /// kt of Whitted's materials acts at every surface; otherwise by length in volumes.
    bool tints_events_;
    std::vector<Medium> media_;
    CoincidentFaces faces_;
    ShadingPoint crossed_;  ///< by a shadow ray
};

}  // namespace alhazen
