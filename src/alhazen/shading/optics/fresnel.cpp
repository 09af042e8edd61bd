#include "alhazen/shading/optics/fresnel.h"

#include <algorithm>
#include <cmath>

namespace alhazen {

double dielectric_reflectance(double cosine, double eta, double& cosine_behind) {
    const double c = std::clamp(cosine, 0.0, 1.0);
    const double squared = 1.0 - eta * eta * (1.0 - c * c);
    if (!(squared > 0.0)) {
        cosine_behind = 0.0;
        return 1.0;
    }
    const double behind = cosine_behind = std::sqrt(squared);
    // Amplitudes of light polarised in the plane of incidence, and across it.
    const double parallel = (c - eta * behind) / (c + eta * behind);
    const double across = (eta * c - behind) / (eta * c + behind);
    return 0.5 * (parallel * parallel + across * across);
}

double dielectric_reflectance(double cosine, double eta) {
    double ignored = 0;
    return dielectric_reflectance(cosine, eta, ignored);
}

double conductor_reflectance(double cosine, double n, double k) {
    const double c = std::clamp(cosine, 0.0, 1.0);
    const double c2 = c * c, s2 = 1.0 - c2;
    const double difference = n * n - k * k - s2;
    const double a2b2 = std::sqrt(difference * difference + 4.0 * n * n * k * k);
    const double a = std::sqrt(std::max(0.0, 0.5 * (a2b2 + difference)));
    const double across = (a2b2 + c2 - 2.0 * a * c) / (a2b2 + c2 + 2.0 * a * c);
    const double x = a2b2 * c2 + s2 * s2, y = 2.0 * a * c * s2;
    // Both are 0 only for n = 1, k = 0 at grazing incidence: there is no boundary.
    if (!(x + y > 0.0)) return 0.0;
    return std::clamp(0.5 * across * (1.0 + (x - y) / (x + y)), 0.0, 1.0);
}

double normal_reflectance_of(double n) {
    const double r = (n - 1.0) / (n + 1.0);
    return r * r;
}

double schlick_weight(double cosine) {
    const double x = 1.0 - std::clamp(cosine, 0.0, 1.0);
    return x * x * x * x * x;
}

}  // namespace alhazen
