#include "alhazen/formats/core/default_conventions.h"

namespace alhazen {

ShadingConventions default_conventions() {
    ShadingConventions c;
    c.ambient_inside_times_kt = false;
    c.clamp_attenuation = false;
    c.air_index = 1.0;
    c.linear_output = false;
    return c;
}

}  // namespace alhazen
