#pragma once
/// Fresnel's equations and Beer's law for the rays of Whitted's equation, in place of its shares
/// and tints; and the volumes around these rays, nested ones included.
///
/// Source: Born and Wolf, "Principles of Optics", 7th edition, 1999, section 1.5.2 (fresnel.h);
/// Beer, "Bestimmung der Absorption des rothen Lichts in farbigen Fluessigkeiten", 1852; Whitted,
/// "An Improved Illumination Model for Shaded Display", 1980 (what they replace).
/// Differs: light is taken as unpolarised before every surface. Shadow rays go straight through
/// boundaries, whose reflectance is then that at the ray's angle on the thinner side: what two
/// parallel faces leave of the light is right, where it falls is not.
/// Conventions: a medium is a number: 0 is outside of all volumes, others stand for a volume and
/// what lies around it. Volumes are left in any order, by the part that bounds them, else by its
/// material. Solids that tell both sides of a surface are one volume. Eyes are outside of all.
/// Threads: for one at a time.

#include <cstdint>
#include <optional>
#include <vector>

#include "alhazen/renderers/core/local_shading.h"

namespace alhazen {

/// Settings of a renderer that has them; what is not given is as the scene says.
struct OpticsSettings {
    std::optional<bool> fresnel, beer;
    void adjust(Optics& optics) const {
        optics.fresnel = fresnel.value_or(optics.fresnel);
        optics.beer = beer.value_or(optics.beer);
    }
};

class ExactOptics {
  public:
    static constexpr std::uint32_t kOutside = 0;

    ExactOptics(const Scene& scene, const Optics& optics);

    /// Media that are made from now on are forgotten by `release(mark())`.
    [[nodiscard]] std::size_t mark() const { return media_.size(); }
    void release(std::size_t mark) { media_.resize(mark); }

    /// Light falls by exp(-absorption * length).
    [[nodiscard]] const Rgb& absorption(std::uint32_t medium) const {
        return media_[medium].absorption;
    }

    /// Completes a point that a ray in medium `around` meets: what it reflects and lets pass, and
    /// the medium behind it.
    void set_media(std::uint32_t around, ShadingPoint& point);

    /// Index on the side of a ray in medium `around` over that behind, at a wavelength, of a point
    /// that `set_media` has completed.
    [[nodiscard]] double eta_by_wave(std::uint32_t around, const ShadingPoint& point,
                                     double nm) const;

    /// What a straight ray meets at a surface.
    struct Straight {
        Rgb through;                      ///< of light, of all that is there
        std::uint32_t behind = kOutside;  ///< medium
    };
    /// `length`: of the way since the last boundary.
    [[nodiscard]] Straight cross(const Surface& surface, const MaterialSample& material,
                                 const Vec3& direction, std::uint32_t around, double length);

  private:
    struct Medium {
        std::uint64_t part = 0;      ///< that bounds it
        std::uint32_t material = 0;  ///< of it
        std::uint32_t around = kOutside;
        bool known = false;  ///< told by a solid
        double index = 1;
        Rgb absorption;
    };
    /// Of a surface, on the way of a ray.
    struct Sides {
        double here = 1, beyond = 1;  ///< indices
        std::uint32_t behind = kOutside;
        Rgb before{1, 1, 1};  ///< tint of the medium that is left at a wall
    };

    [[nodiscard]] Sides sides_of(const Surface& surface, const MaterialSample& material,
                                 bool entering, std::uint32_t around);
    [[nodiscard]] Sides known_sides_of(const Surface& surface, std::uint32_t around);
    [[nodiscard]] Medium medium_of(const Surface& surface, const MaterialSample& sample) const;
    std::uint32_t enter(Medium medium, std::uint32_t around);
    /// The medium where `volume` has been left.
    [[nodiscard]] std::uint32_t without(const Medium& volume, std::uint32_t around);
    std::uint32_t remove(std::uint32_t left, std::uint32_t around);
    [[nodiscard]] Rgb tint_of(const MaterialSample& sample) const;
    void turn(const Surface& surface, double cosine, double here, double beyond,
              MaterialSample& sample) const;

    const Scene& scene_;
    Optics optics_;
    bool tints_events_;  ///< kt of Whitted's materials counts at every surface
    std::vector<Medium> media_;
};

}  // namespace alhazen
