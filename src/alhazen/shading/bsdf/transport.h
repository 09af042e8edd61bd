#pragma once
/// The transported quantity of a BSDF, and its samples.
///
/// Source: Veach, "Robust Monte Carlo Methods for Light Transport Simulation", 1997, section 5.2.

#include <cstdint>

#include "alhazen/math/vec.h"
#include "alhazen/shading/spectrum/spectrum.h"

namespace alhazen {

/// The quantity carried along `view`: radiance to an eye, or importance to a light. They differ by
/// eta^2 at a refraction.
enum class Transport : std::uint8_t { Radiance, Importance };

struct BsdfSample {
    Vec3 direction;         ///< unit, local; z < 0: transmitted
    Spectrum weight;        ///< value * |cosine| / density
    double density = 0;     ///< by solid angle; for a singular lobe the probability of its choice
    bool singular = false;  ///< true: the directions of the lobe have no density
    double eta = 1;         ///< transmitted: index on the side it enters over that it left
    /// The direction is valid for the first wavelength only, and so is `weight`.
    bool dispersed = false;
};

}  // namespace alhazen
