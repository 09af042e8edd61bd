#pragma once
/// An SVG figure of a sampler: its points, their periodogram and its radial mean.
///
/// Source: Ulichney, "Dithering with Blue Noise", Proc. IEEE 76(1), 1988 (the form of the figure).
/// Conventions: x right, y up; the grey of the periodogram is white at three times the power of
/// independent points. For a progressive sampler the first quarter of the points is dark, and the
/// radial mean of that quarter is also drawn.

#include <cstdint>
#include <string>
#include <vector>

#include "alhazen/math/vec.h"
#include "alhazen/sampling/analysis/periodogram.h"
#include "alhazen/sampling/samplers/sampler.h"

namespace alhazen {

struct SampleStudyOptions {
    std::uint32_t points = 256;  ///< per pixel, 1 .. kMostStudied
    std::uint32_t sets = 0;      ///< pixels averaged; 0: 16384 / points, from 4 to 256
    std::uint32_t pair = 0;
    std::uint64_t seed = 0;
    SamplePixel pixel;  ///< the pixel drawn, and the first of those averaged
};

inline constexpr std::uint32_t kMostStudied = 4096;
inline constexpr std::uint32_t kMostStudiedSets = 4096;

struct SampleStudy {
    const SamplerEntry* sampler;
    SampleStudyOptions options;
    std::vector<Vec2> points;  ///< of the first pixel
    double discrepancy;        ///< star discrepancy; mean of the sets
    /// Distance of the nearest two points on the torus, times root(points); mean of the sets.
    double distance;
    Periodogram periodogram;
    std::vector<double> radial;          ///< mean power at radii, kStudyBins to root(points)
    std::vector<double> radial_quarter;  ///< of the first quarter; empty if not progressive
};
inline constexpr int kStudyBins = 8;

[[nodiscard]] SampleStudy study_sampler(const SamplerEntry& sampler,
                                        const SampleStudyOptions& options);
[[nodiscard]] std::string sample_figure(const SampleStudy& study);

}  // namespace alhazen
