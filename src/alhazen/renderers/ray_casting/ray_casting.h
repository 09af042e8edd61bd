#pragma once
/// Ray casting: eye rays only; visible surfaces are shaded without shadows.
///
/// Source: Appel, "Some Techniques for Shading Machine Renderings of Solids", AFIPS 1968; Goldstein
/// and Nagel, "3-D Visual Simulation", Simulation 16(1), 1971.
/// Differs: no shadows; the shading is the local part of `whitted`.

#include "alhazen/renderers/antialias/single_rays.h"

namespace alhazen {

class RayCasting final : public SingleRayRenderer {
  public:
    [[nodiscard]] bool reflects() const override { return false; }
    [[nodiscard]] std::unique_ptr<TileRenderer> begin(const RenderJob& job) const override;
    [[nodiscard]] std::unique_ptr<RayAnswers> answers(const RenderJob& job) const override;
};

}  // namespace alhazen
