#pragma once
/// The change of a cone at a curved surface that reflects or refracts it.
///
/// Source: Coddington's equations, as in Welford, "Aberrations of Optical Systems", 1986, section
/// 4.3; Amanatides, "Ray Tracing with Cones", SIGGRAPH 1984, section 4 (new virtual origin and
/// spread).
/// Differs: the surface has two principal curvatures in any direction; the tangential and sagittal
/// curvatures are those of the normal sections. The resulting wavefront is astigmatic; it is
/// replaced by a circular cone of equal area, whose spread is the geometric mean.
/// Conventions: curvature is positive if the surface is convex towards the incoming cone.
/// `vergence` is spread over radius: 1 / distance of the virtual apex, negative for a converging
/// cone. Spreads are at most 1, an angle of pi / 2 at the apex.

#include <algorithm>
#include <cmath>

namespace alhazen {

/// The curvatures of a surface in the plane of incidence and perpendicular to it.
struct SectionCurvatures {
    double tangential = 0, sagittal = 0;
};

inline constexpr double kWidestSpread = 1.0;

/// The spread of the circular cone with the area of a cone of two spreads.
[[nodiscard]] inline double equal_area_spread(double a, double b) {
    const double mean = std::sqrt(std::abs(a * b));
    return std::clamp(a + b < 0.0 ? -mean : mean, -kWidestSpread, kWidestSpread);
}

/// The spread of a cone after reflection. `radius` and `spread`: of the incoming cone at the
/// surface; `cosine`: of the angle of incidence, in (0, 1].
[[nodiscard]] inline double mirrored_spread(double radius, double spread, double cosine,
                                            const SectionCurvatures& of) {
    const double t = spread + 2.0 * radius * of.tangential / cosine;
    const double s = spread + 2.0 * radius * of.sagittal * cosine;
    return equal_area_spread(t, s);
}

struct RefractedCone {
    double radius = 0, spread = 0;
};
/// The cone after refraction. `eta`: index on this side over the index behind; `cosine_behind`: of
/// the angle of refraction.
[[nodiscard]] inline RefractedCone refracted_cone(double radius, double spread, double cosine,
                                                  double cosine_behind, double eta,
                                                  const SectionCurvatures& of) {
    // n' cos'^2 V' = n cos^2 V - (n' cos' - n cos) k, with n / n' = eta and V = spread / radius;
    // the radius in the plane of incidence is multiplied by cos' / cos.
    const double power = cosine_behind - eta * cosine;
    const double behind = std::max(cosine_behind, 1e-3);
    const double t = (eta * cosine * cosine * spread - power * radius * of.tangential) /
                     (behind * behind) * (behind / cosine);
    const double s = eta * spread - power * radius * of.sagittal;
    return {radius * std::sqrt(behind / cosine), equal_area_spread(t, s)};
}

/// The spread after a rough surface that scatters a ray over a cone of half angle `angle`: the
/// directions are sums, so their variances add.
[[nodiscard]] inline double widened_spread(double spread, double angle) {
    const double tangent = std::tan(std::min(angle, 0.78539816339744831));
    const double wide = std::min(std::hypot(spread, tangent), kWidestSpread);
    return angle > 0.0 ? wide : spread;
}

}  // namespace alhazen
