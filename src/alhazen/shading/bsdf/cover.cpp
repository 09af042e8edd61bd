#include "alhazen/shading/bsdf/cover.h"

#include <algorithm>

#include "alhazen/shading/optics/fresnel.h"

namespace alhazen {

double Cover::transmittance(double cosine) const {
    const double reflected = f0 + schlick_weight(cosine) * (f90 - f0);
    return std::clamp(1.0 - share * reflected, 0.0, 1.0);
}

}  // namespace alhazen
