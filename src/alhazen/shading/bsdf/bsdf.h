#pragma once
/// How a point of a surface scatters light: a weighted sum of lobes (lobe.h), each with value,
/// sample, density and albedo in closed form.
///
/// Source: Nicodemus et al., "Geometrical Considerations and Nomenclature for Reflectance", NBS
/// 1977; Veach, "Robust Monte Carlo Methods for Light Transport Simulation", 1997, chapters 3 and 5
/// (BSDFs, and their adjoints where light is refracted).
/// Conventions: directions are unit, away from the surface, in the local frame of the point: z is
/// the shading normal on the side of the view (the z of a view is > 0), x the tangent. `value` has
/// no cosine. Singular lobes (mirrors, smooth glass) are known to `sample` alone.
/// Threads: const functions may be called from many.

#include <cstdint>
#include <optional>
#include <span>

#include "alhazen/imaging/image/rgb.h"
#include "alhazen/math/vec.h"
#include "alhazen/shading/materials/material.h"

namespace alhazen {

/// What is carried along `view`: radiance to an eye, or importance to a light. They differ by
/// eta^2 where a ray is refracted.
enum class Transport : std::uint8_t { Radiance, Importance };

struct BsdfSample {
    Vec3 direction;         ///< unit, local; z < 0: transmitted
    Rgb weight;             ///< value * |cosine| / density
    double density = 0;     ///< by solid angle; of a singular lobe the probability of its choice
    bool singular = false;  ///< its directions have no density
    double eta = 1;         ///< of a transmitted ray: index where it enters over where it came from
};

class Bsdf {
  public:
    /// Per steradian, without singular lobes.
    [[nodiscard]] Rgb value(const Vec3& view, const Vec3& direction, Transport transport) const;
    /// With which `sample(view)` gives `direction`, by solid angle, without singular lobes. (A
    /// sample's own density is this.)
    [[nodiscard]] double density(const Vec3& view, const Vec3& direction) const;
    /// `choice` and `u` in [0, 1). Empty where the light is absorbed.
    [[nodiscard]] std::optional<BsdfSample> sample(const Vec3& view, double choice, const Vec2& u,
                                                   Transport transport) const;
    /// Share of the light from all directions that goes to `view`, or a close approximation.
    [[nodiscard]] Rgb albedo(const Vec3& view) const;
    /// False: only singular lobes, or none: lights need not be sampled.
    [[nodiscard]] bool has_density() const;
    /// Whether `value` may be above 0 below the surface.
    [[nodiscard]] bool transmits() const;
};

/// Where a BSDF is asked for.
struct BsdfPlace {
    /// Index of the medium on the side of the view over that behind, for what has no index of its
    /// own two sides (CSG walls); else 0: by the material's index and `from_inside`.
    double eta = 0;
    bool from_inside = false;  ///< the view is inside the volume that the surface bounds
};

/// The BSDF of a material at a point.
[[nodiscard]] Bsdf bsdf_of(const Material& material, std::span<const Texture> textures,
                           const SurfaceLookup& lookup, const BsdfPlace& place);

}  // namespace alhazen
