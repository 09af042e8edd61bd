#pragma once
/// Scattering inside a homogeneous volume: sampling of distances and directions.
///
/// Source: Henyey and Greenstein, "Diffuse Radiation in the Galaxy", Astrophysical Journal 93,
/// 1941; Pharr, Jakob and Humphreys, "Physically Based Rendering", 4th ed., sections 11.3.1
/// and 14.1 (their sampling); Wilkie et al., "Hero Wavelength Spectral Sampling", EGSR 2014 (one
/// channel draws the distance, the others weight it).
/// Differs: the channel is chosen by the throughput of the path.
/// Conventions: cosines are of the scattering angle, 1 straight on; directions are those of travel
/// of the path, from either end.

#include "alhazen/math/vec.h"
#include "alhazen/shading/spectrum/spectrum.h"

namespace alhazen {

/// The phase function by solid angle; integrates to 1.
[[nodiscard]] double henyey_greenstein(double cosine, double anisotropy);
/// Samples a direction with that density; `direction` must be unit.
[[nodiscard]] Vec3 sample_henyey_greenstein(const Vec3& direction, double anisotropy,
                                            const Vec2& u);

struct VolumeStep {
    bool scatters = false;  ///< before the end
    double distance = 0;    ///< to the scattering, else to the end
    Spectrum weight;        ///< value over density
    Spectrum arrived;       ///< if it scatters: transmittance to that point over density
};

/// Samples the next event of a path of `throughput` along `length`, which may be infinite. `u` in
/// [0, 1)^2.
[[nodiscard]] VolumeStep step_in_volume(const Spectrum& absorption, const Spectrum& scattering,
                                        const Spectrum& throughput, double length, const Vec2& u);

}  // namespace alhazen
