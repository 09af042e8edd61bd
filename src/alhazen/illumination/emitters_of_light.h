#pragma once
/// The surfaces of lights with extent that no ray sees, as emitters.

#include <vector>

#include "alhazen/illumination/emitter.h"
#include "alhazen/shading/lights/light.h"

namespace alhazen {

/// Appends them, ready.
void append_emitters_of_light(const AreaLight& light, std::vector<Emitter>& emitters);

}  // namespace alhazen
