#pragma once
/// The power heuristic: the weight of a sample that another strategy could have drawn.
///
/// Source: Veach and Guibas, "Optimally Combining Sampling Techniques for Monte Carlo Rendering",
/// SIGGRAPH 1995, equation 15, with the exponent 2.

#include "alhazen/scene/scene.h"

namespace alhazen {

/// `own`, `other`: densities of one sample each; `own` above 0.
[[nodiscard]] inline double power_heuristic(double own, double other) {
    const double ratio = other / own;
    return 1.0 / (1.0 + ratio * ratio);
}

/// The weights of light at a point that scatters by a density, which shadow rays and scattered rays
/// that hit the light both find. If some part is not in the way of both, light that shadow rays can
/// find is what they find.
class DirectLightWeights {
  public:
    explicit DirectLightWeights(const Scene& scene) : shadow_rays_(scene.hides_lights_from_some) {}

    /// True if scattered rays do not count for light that is drawn.
    [[nodiscard]] bool shadow_rays_alone() const { return shadow_rays_; }
    /// `drawn`: density of drawing the light, above 0; `scattered`: that of the scattered ray.
    [[nodiscard]] double of_shadow_ray(double drawn, double scattered) const {
        return shadow_rays_ ? 1.0 : power_heuristic(drawn, scattered);
    }
    [[nodiscard]] double of_hit(double scattered, double drawn) const {
        if (shadow_rays_) return drawn > 0.0 ? 0.0 : 1.0;
        return power_heuristic(scattered, drawn);
    }

  private:
    bool shadow_rays_;
};

}  // namespace alhazen
