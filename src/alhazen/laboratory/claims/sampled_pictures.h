#pragma once
/// Pictures for claims about sampling, with their cost.

#include <span>

#include "alhazen/imaging/film/film.h"
#include "alhazen/renderers/core/renderer.h"

namespace alhazen {

struct SampledPicture {
    Film film;
    RenderReport report;
};

/// Methods of sampling besides the number of samples; at most one is set.
struct SampleChoice {
    const AntialiasSettings* antialias = nullptr;
    const SamplingPlan* sampling = nullptr;
};

/// Renders a square picture with one thread from the first camera of the scene.
[[nodiscard]] SampledPicture sampled(const Scene& scene, const Renderer& renderer, int side,
                                     int samples, const SampleChoice& choice = {},
                                     std::uint64_t seed = 0);

/// Root mean square error of values clamped at 1, as displayed.
[[nodiscard]] double shown_rmse(const Film& a, const Film& b);

/// Rays or samples per pixel, and the error of the picture.
struct RaysAndError {
    double rays, error;
};

/// Number of rays that uniform sampling needs for an error: a power law between neighbours,
/// extrapolated from the last two. Precondition: at least two entries, by decreasing error.
[[nodiscard]] double rays_for(std::span<const RaysAndError> uniform, double error);

}  // namespace alhazen
