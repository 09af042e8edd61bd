#pragma once
/// Ambient occlusion: the fraction of the sky visible from each point, for previews of shapes.
///
/// Source: Zhukov, Iones and Kronin, "An Ambient Light Illumination Model", EGWR 1998; Landis,
/// "Production-Ready Global Illumination", SIGGRAPH 2002 course 16.
/// Conventions: the sky is white and uniform: an unoccluded matt white surface has the radiance 1.
/// Occluders beyond `distance` are ignored. Surfaces have their albedo if `albedo` is true, else
/// they are white. Eye rays without a hit have the background.

#include "alhazen/renderers/core/renderer.h"

namespace alhazen {

struct OcclusionSettings {
    double distance = 0;  ///< 0: a quarter of the scene's diagonal
    bool albedo = false;
};

class AmbientOcclusion final : public Renderer {
  public:
    explicit AmbientOcclusion(const OcclusionSettings& settings) : settings_(settings) {}

    /// Without RenderJob::sampling: uses `sobol` and `box`.
    [[nodiscard]] RenderReport render(const RenderJob& job, Film& film) const override;
    [[nodiscard]] bool takes_samplers() const override { return true; }
    [[nodiscard]] bool distributes() const override { return true; }
    [[nodiscard]] int usual_samples() const override { return 16; }

  private:
    OcclusionSettings settings_;
};

}  // namespace alhazen
