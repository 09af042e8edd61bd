#pragma once
/// Wavelengths that a refracted ray is split into where glass disperses, and their colours.
///
/// Source: Thomas, "Dispersive Refraction in Ray Tracing", The Visual Computer 2, 1986 (a refracted
/// ray for each of a few wavelengths); CIE 15:2004 (color_matching.h).
/// Differs: a ray is split once, at the first surface that disperses; from there on it is of one
/// wavelength. Each stands for a share of what is seen of white light, all shares being equal in
/// sum over the channels. Colours beyond sRGB are clipped, and each channel scaled so that all
/// together are white.

#include <vector>

#include "alhazen/imaging/image/rgb.h"

namespace alhazen {

struct ShadingPoint;
struct Scene;

class WaveSplit {
  public:
    static constexpr int kFewest = 3, kMost = 64;

    struct Wave {
        double nm = 0;
        Rgb weight;  ///< not below 0; the sum over all waves is (1, 1, 1)
    };

    /// `count`: kFewest to kMost, from short to long.
    explicit WaveSplit(int count);

    [[nodiscard]] const std::vector<Wave>& waves() const { return waves_; }

  private:
    std::vector<Wave> waves_;
};

/// Index on the side of the ray over that behind, at a wavelength; of a scene without exact optics.
[[nodiscard]] double eta_by_wave(const Scene& scene, const ShadingPoint& point, double nm);

}  // namespace alhazen
