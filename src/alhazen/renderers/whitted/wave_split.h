#pragma once
/// The wavelengths into which dispersing glass splits a refracted ray, and their colours.
///
/// Source: Thomas, "Dispersive Refraction in Ray Tracing", The Visual Computer 2, 1986 (a refracted
/// ray for each of a few wavelengths); CIE 15:2004 (color_matching.h).
/// Differs: a ray is split once, at the first dispersing surface; the rays behind it have one
/// wavelength each. Each wavelength stands for an equal share of the visible white light (summed
/// over the channels). Colours outside sRGB are clipped; channels are scaled so that the sum of all
/// wavelengths is white.

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

    /// `count`: kFewest to kMost. Wavelengths are ascending.
    explicit WaveSplit(int count);

    [[nodiscard]] const std::vector<Wave>& waves() const { return waves_; }

  private:
    std::vector<Wave> waves_;
};

/// Refractive index on the side of the ray over that behind, at wavelength `nm`, for scenes without
/// exact optics.
[[nodiscard]] double eta_by_wave(const Scene& scene, const ShadingPoint& point, double nm);

}  // namespace alhazen
