#pragma once
/// Distributed ray tracing: the equation of `whitted`, with the rays of a sample distributed over
/// the pixel, the lens, time, the surfaces of lights, and rough reflections and refractions.
///
/// Source: Cook, Porter and Carpenter, "Distributed Ray Tracing", SIGGRAPH 1984; Cook, "Stochastic
/// Sampling in Computer Graphics", ACM TOG 5(1), 1986.
/// Differs: samples come from a named sampler instead of jittered cells; each light is sampled at
/// each point; lobes are those of Phong, with directions below the surface mirrored at it.
/// Conventions: pairs of dimensions of the sampler, with d the number of bounces and L the number
/// of lights: 0 pixel; 1 lens; 2 time; from 3 + d (L + 2) on: reflected lobe, refracted lobe, the
/// point on each light. A scene with nothing to distribute has the bits of `whitted` with that
/// sampler.

#include "alhazen/renderers/core/tiles.h"
#include "alhazen/renderers/volumes/exact_optics.h"

namespace alhazen {

class Distributed final : public TiledRenderer {
  public:
    explicit Distributed(const OpticsSettings& optics = {}) : optics_(optics) {}

    /// Without RenderJob::round nothing is distributed: the tile is that of `whitted`.
    [[nodiscard]] std::unique_ptr<TileRenderer> begin(const RenderJob& job) const override;
    /// Without RenderJob::sampling: uses `sobol` and `box`.
    [[nodiscard]] RenderReport render(const RenderJob& job, Film& film) const override;
    [[nodiscard]] bool distributes() const override { return true; }
    [[nodiscard]] int usual_samples() const override { return 16; }
    void adjust(ShadingConventions& c) const override { optics_.adjust(c.optics); }
    [[nodiscard]] bool heeds_optics() const override { return true; }

  private:
    OpticsSettings optics_;
};

}  // namespace alhazen
