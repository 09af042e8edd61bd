#pragma once
/// Renders the picture of a trial with another accelerator and compares it with the reference:
/// every bit of every pixel, and the numbers of rays and hits of each kind.
///
/// Conventions: if the whole picture would take too long, randomly spread square tiles (fixed seed)
/// are rendered and compared, each with its own rays.

#include <vector>

#include "alhazen/laboratory/compare.h"

namespace alhazen {

class PictureChecker {
  public:
    explicit PictureChecker(const SceneTrial& trial) : trial_(trial) {}

    /// Takes about `seconds`, estimated from the times in `figures`. Returns Measurement::cost.
    [[nodiscard]] std::vector<float> check(const Scene& scene, const ReplayFigures& figures,
                                           double seconds, PictureCheck& check) const;

  private:
    [[nodiscard]] RenderOptions options_for(const PixelBox* crop) const;
    void compare(const RenderResult& found, const RenderResult& expected, std::vector<float>& cost,
                 PictureCheck& check) const;

    const SceneTrial& trial_;
};

}  // namespace alhazen
