#pragma once
/// The common base of the renderers that follow light from surface to surface.

#include "alhazen/renderers/core/renderer.h"

namespace alhazen {

/// Without RenderJob::sampling the sampler is `sobol` and the filter `box`.
class LightTransportRenderer : public Renderer {
  public:
    [[nodiscard]] bool takes_samplers() const override { return true; }
    [[nodiscard]] bool distributes() const override { return true; }
    [[nodiscard]] bool follows_light() const override { return true; }
    [[nodiscard]] int usual_samples() const override { return 64; }
};

}  // namespace alhazen
