#pragma once
/// Pictures of claims about sampling, and what they cost.

#include <span>

#include "alhazen/imaging/film/film.h"
#include "alhazen/renderers/core/renderer.h"

namespace alhazen {

struct SampledPicture {
    Film film;
    RenderReport report;
};

/// Ways to choose samples besides their number; at most one.
struct SampleChoice {
    const AntialiasSettings* antialias = nullptr;
    const SamplingPlan* sampling = nullptr;
};

/// A square picture by one thread, as the first camera of the scene sees it.
[[nodiscard]] SampledPicture sampled(const Scene& scene, const Renderer& renderer, int side,
                                     int samples, const SampleChoice& choice = {},
                                     std::uint64_t seed = 0);

/// Of values cut off at 1, as they are shown.
[[nodiscard]] double shown_rmse(const Film& a, const Film& b);

/// Rays or samples for a pixel, and the error of the picture.
struct RaysAndError {
    double rays, error;
};

/// Rays that the uniform pictures need for an error: a power law between neighbours, and beyond
/// the last by the law of the last two. Precondition: two at least, by falling error.
[[nodiscard]] double rays_for(std::span<const RaysAndError> uniform, double error);

}  // namespace alhazen
