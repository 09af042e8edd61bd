#pragma once
/// Light that is scattered inside a volume, the same everywhere in it: how far it gets, and where
/// it turns.
///
/// Source: Henyey and Greenstein, "Diffuse Radiation in the Galaxy", Astrophysical Journal 93,
/// 1941; Pharr, Jakob and Humphreys, "Physically Based Rendering", 4th ed., sections 11.3.1
/// and 14.1 (their sampling); Wilkie et al., "Hero Wavelength Spectral Sampling", EGSR 2014 (one
/// channel draws the distance, the others weigh it). Differs: the channel is chosen by the
/// throughput of the path. Conventions: cosines are of the angle by which light turns, 1 straight
/// on; directions are those in which paths go, for either of their ends.

#include "alhazen/math/vec.h"
#include "alhazen/shading/spectrum/spectrum.h"

namespace alhazen {

/// By solid angle; integrates to 1.
[[nodiscard]] double henyey_greenstein(double cosine, double anisotropy);
/// With that density; `direction` unit.
[[nodiscard]] Vec3 sample_henyey_greenstein(const Vec3& direction, double anisotropy,
                                            const Vec2& u);

struct VolumeStep {
    bool scatters = false;  ///< before the end
    double distance = 0;    ///< to where it does
    Spectrum weight;        ///< of what happens: value over density
    Spectrum arrived;       ///< where it scatters: what arrives there over density
};

/// What happens to a path of `throughput` along `length`, which may be infinite. `u` in [0, 1)^2.
[[nodiscard]] VolumeStep step_in_volume(const Spectrum& absorption, const Spectrum& scattering,
                                        const Spectrum& throughput, double length, const Vec2& u);

}  // namespace alhazen
