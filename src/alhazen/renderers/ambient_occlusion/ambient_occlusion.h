#pragma once
/// Ambient occlusion: how much of the sky each point sees, as a quick look at a shape.
///
/// Source: Zhukov, Iones and Kronin, "An Ambient Light Illumination Model", EGWR 1998; Landis,
/// "Production-Ready Global Illumination", SIGGRAPH 2002 course 16.
/// Conventions: the sky is white and even: a matt white surface without anything in front of it
/// shows 1. Nothing farther than `distance` counts. Materials show their albedo where `albedo` is
/// true. What the eye does not meet shows the background.

#include "alhazen/renderers/core/renderer.h"

namespace alhazen {

struct OcclusionSettings {
    double distance = 0;  ///< 0: a quarter of the scene's diagonal
    bool albedo = false;
};

class AmbientOcclusion final : public Renderer {
  public:
    explicit AmbientOcclusion(const OcclusionSettings& settings) : settings_(settings) {}

    /// Without RenderJob::sampling: `sobol` and `box`.
    [[nodiscard]] RenderReport render(const RenderJob& job, Film& film) const override;
    [[nodiscard]] bool takes_samplers() const override { return true; }
    [[nodiscard]] bool distributes() const override { return true; }
    [[nodiscard]] int usual_samples() const override { return 16; }

  private:
    OcclusionSettings settings_;
};

}  // namespace alhazen
