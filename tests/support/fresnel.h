#pragma once
/// Fresnel's reflectance, as a reference.

#include <cmath>

namespace alhazen::testing {

/// Share of unpolarised light that smooth glass of a relative index reflects.
inline double fresnel(double cosine, double index) {
    const double behind = std::sqrt(1.0 - (1.0 - cosine * cosine) / (index * index));
    const double s = (cosine - index * behind) / (cosine + index * behind);
    const double p = (index * cosine - behind) / (index * cosine + behind);
    return 0.5 * (s * s + p * p);
}

}  // namespace alhazen::testing
