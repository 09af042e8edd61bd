#pragma once
/// A clear sky with its sun, as a latitude-longitude picture.
///
/// Source: Hillaire, "A Scalable and Production Ready Sky and Atmosphere Rendering Technique",
/// EGSR 2020: single scattering along each ray, all further orders as an isotropic series (section
/// 5.5), the medium of its table 1 (Rayleigh, Mie, ozone); Bruneton and Neyret, "Precomputed
/// Atmospheric Scattering", EGSR 2008; Preetham, Shirley and Smits, "A Practical Analytic Model for
/// Daylight", SIGGRAPH 1999 (turbidity: the optical depth of all over that of the molecules).
/// Differs: for one place at the ground and one sun, in three bands; the density of haze follows
/// from the turbidity. The table of Hosek and Wilkie 2012 is not used: the physical medium covers
/// any turbidity, and directions below the horizon.
/// Conventions: the frame of DirectionPicture; white light above the air, of irradiance
/// kSunIrradiance across its direction. Below the horizon is the ground.

#include "alhazen/imaging/image/image.h"
#include "alhazen/math/vec.h"

namespace alhazen {

inline constexpr double kSunIrradiance = 4.0;
/// Half of 0.533 degrees.
inline constexpr double kSunRadius = 0.533 / 2.0 * 3.14159265358979323846 / 180.0;

struct ClearSky {
    Image picture;     ///< without the sun
    Rgb sun_radiance;  ///< radiance of its disc; black if it has set
};

/// The sky for unit `to_sun`, `turbidity` >= 1 and the albedo `ground`.
[[nodiscard]] ClearSky clear_sky(const Vec3& to_sun, double turbidity, const Rgb& ground);

}  // namespace alhazen
