#pragma once
/// Path tracing: the rendering equation by random paths from the eye, lights sampled at each
/// surface and hit by chance, both weighed by their densities.
///
/// Source: Kajiya, "The Rendering Equation", SIGGRAPH 1986; Veach and Guibas, "Optimally Combining
/// Sampling Techniques for Monte Carlo Rendering", SIGGRAPH 1995 (multiple importance sampling, the
/// power heuristic); Arvo and Kirk, "Particle Transport and Image Synthesis", SIGGRAPH 1990
/// (Russian roulette); Laine, Karras and Aila, "Megakernels Considered Harmful", HPG 2013
/// (wavefronts).
/// Differs: the terms of Whitted's equation that stand for light from everywhere (ambient lights)
/// are not used; that light is found.
/// Conventions: pairs of dimensions as in light_transport/path_chance.h. Pixels depend neither on
/// the threads nor on tiles.

#include "alhazen/renderers/light_transport/light_transport_renderer.h"
#include "alhazen/renderers/light_transport/path_settings.h"

namespace alhazen {

class Illumination;

class PathTracing final : public LightTransportRenderer {
  public:
    explicit PathTracing(const PathSettings& settings) : settings_(settings) {}

    [[nodiscard]] RenderReport render(const RenderJob& job, Film& film) const override;

    [[nodiscard]] bool scatters_in_volumes() const override { return !settings_.manifold; }

  private:
    PathSettings settings_;
};

/// The same for lights that are ready.
[[nodiscard]] RenderReport trace_paths(const RenderJob& job, const Illumination& lights,
                                       const PathSettings& settings, Film& film);

}  // namespace alhazen
