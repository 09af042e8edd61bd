#pragma once
/// Path tracing: random paths from the eye, with lights sampled at each surface and hit by
/// scattered rays, both weighted by their densities.
///
/// Source: Kajiya, "The Rendering Equation", SIGGRAPH 1986; Veach and Guibas, "Optimally Combining
/// Sampling Techniques for Monte Carlo Rendering", SIGGRAPH 1995 (multiple importance sampling, the
/// power heuristic); Arvo and Kirk, "Particle Transport and Image Synthesis", SIGGRAPH 1990
/// (Russian roulette); Laine, Karras and Aila, "Megakernels Considered Harmful", HPG 2013
/// (wavefronts).
/// Differs: ambient lights of Whitted's equation are not used, since indirect light is computed.
/// Conventions: pairs of dimensions as in light_transport/path_randomness.h. Pixels depend neither
/// on the threads nor on tiles.

#include <chrono>

#include "alhazen/renderers/light_transport/light_transport_renderer.h"
#include "alhazen/renderers/light_transport/path_settings.h"

namespace alhazen {

class Illumination;

class PathTracing final : public LightTransportRenderer {
  public:
    explicit PathTracing(const PathSettings& settings) : settings_(settings) {}

    [[nodiscard]] RenderReport render(const RenderJob& job, Film& film) const override;
    [[nodiscard]] bool takes_wavelengths() const override {
        return !settings_.manifold;  // chains have one refractive index
    }

    [[nodiscard]] bool scatters_in_volumes() const override { return !settings_.manifold; }

  private:
    PathSettings settings_;
};

/// Renders by path tracing with given `lights`.
[[nodiscard]] RenderReport trace_paths(
    const RenderJob& job, const Illumination& lights, const PathSettings& settings, Film& film,
    std::chrono::steady_clock::time_point begin = std::chrono::steady_clock::now());

}  // namespace alhazen
