#pragma once
/// Glass, and what is seen through it.

#include "support/light_pictures.h"

namespace alhazen::testing {

inline constexpr double kGlassIndex = 1.5;
/// Fresnel's reflectance of glass at normal incidence.
inline constexpr double kGlassReflectance =
    (kGlassIndex - 1) * (kGlassIndex - 1) / ((kGlassIndex + 1) * (kGlassIndex + 1));

inline Material absorbing_glass(const Rgb& absorption, double index = kGlassIndex) {
    Material m;
    m.dielectric = Dielectric{absorption};
    m.index.value = index;
    return m;
}

/// A wall of radiance 1 seen by parallel rays along -z.
inline SceneMaker wall_of_light() {
    SceneMaker maker;
    maker.description().cameras[0].camera =
        OrthographicCamera{{0, 0, 5}, {0, 0, -1}, {0.1, 0, 0}, {0, 0.1, 0}};
    maker.add(rectangle({-9, -9, -3}, {18, 0, 0}, {0, 18, 0}), maker.material(shining({1, 1, 1})));
    return maker;
}

/// Through a slab of transmittance t: both sides reflect, again and again.
inline double through_slab(double t) {
    return (1 - kGlassReflectance) * (1 - kGlassReflectance) * t /
           (1 - kGlassReflectance * kGlassReflectance * t * t);
}

}  // namespace alhazen::testing
