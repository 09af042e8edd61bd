#pragma once
/// The surfaces of area lights that are invisible to rays, as emitters.

#include <vector>

#include "alhazen/illumination/emitter.h"
#include "alhazen/shading/lights/light.h"

namespace alhazen {

/// Appends the emitters of a light, after `make_ready`; area 0: not usable.
void append_emitters_of_light(const AreaLight& light, std::vector<Emitter>& emitters);

}  // namespace alhazen
