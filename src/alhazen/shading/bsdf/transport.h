#pragma once
/// What a BSDF carries, and what its samples are.
///
/// Source: Veach, "Robust Monte Carlo Methods for Light Transport Simulation", 1997, section 5.2.

#include <cstdint>

#include "alhazen/math/vec.h"
#include "alhazen/shading/spectrum/spectrum.h"

namespace alhazen {

/// What is carried along `view`: radiance to an eye, or importance to a light. They differ by
/// eta^2 where a ray is refracted.
enum class Transport : std::uint8_t { Radiance, Importance };

struct BsdfSample {
    Vec3 direction;         ///< unit, local; z < 0: transmitted
    Spectrum weight;        ///< value * |cosine| / density
    double density = 0;     ///< by solid angle; of a singular lobe the probability of its choice
    bool singular = false;  ///< its directions have no density
    double eta = 1;         ///< of a transmitted ray: index where it enters over where it came from
};

}  // namespace alhazen
