#pragma once
/// What all renderers that follow light from surface to surface have in common.

#include "alhazen/renderers/core/renderer.h"

namespace alhazen {

/// Without RenderJob::sampling: `sobol` and `box`.
class LightTransportRenderer : public Renderer {
  public:
    [[nodiscard]] bool takes_samplers() const override { return true; }
    [[nodiscard]] bool distributes() const override { return true; }
    [[nodiscard]] bool follows_light() const override { return true; }
    [[nodiscard]] int usual_samples() const override { return 64; }
};

}  // namespace alhazen
