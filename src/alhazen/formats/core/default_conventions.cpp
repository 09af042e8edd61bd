#include "alhazen/formats/core/default_conventions.h"

namespace alhazen {

Conventions default_conventions() {
    Conventions c;
    c.shading.ambient_inside_times_kt = false;
    c.shading.clamp_attenuation = false;
    c.shading.air_index = 1.0;
    c.film.linear_output = false;
    return c;
}

}  // namespace alhazen
