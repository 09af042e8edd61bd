#pragma once
/// Lane and Carpenter's algorithm: patches are split where the scan line meets them, and converted
/// to polygons once they are flat.
///
/// Source: Lane, Carpenter, Whitted and Blinn, "Scan Line Methods for Displaying Parametrically
/// Defined Surfaces", CACM 23(1), 1980; Foley, van Dam, Feiner and Hughes, "Computer Graphics:
/// Principles and Practice", 2nd ed., 1990, Fig. 15.54.
/// Differs: hidden surfaces are removed by the depth of each sample along the spans; a patch
/// between the samples is dropped.
/// Conventions: `next` gives the scan lines of the crop from the top. The visible surface at a
/// sample is independent of the order of the patches and of the crop.
/// Complexity: O(n log n) for n polygons; memory: patches that lie below or cross the scan line.

#include <memory>
#include <span>
#include <vector>

#include "alhazen/renderers/core/reports/scan_line_report.h"
#include "alhazen/renderers/lane_carpenter/options.h"
#include "alhazen/renderers/lane_carpenter/sample_grid.h"
#include "alhazen/renderers/lane_carpenter/scan_scene.h"

namespace alhazen {

/// The visible surface at a sample.
struct ScanSample {
    static constexpr std::uint32_t kNothing = 0xFFFFFFFFu;
    static constexpr std::uint32_t kFacet = 0x80000000u;  ///< bit of a facet's number

    std::uint32_t item = kNothing;  ///< index of the piece, or of the facet
    double nearness = 0;
    double u = 0, v = 0;  ///< in the unit square of the piece
};

/// A surface that may be transparent.
struct ScanVeil {
    std::uint32_t sample = 0;  ///< column * samples + index in the pixel
    ScanSample seen;
};

struct ScanRow {
    std::vector<ScanSample> samples;  ///< [column][sample]: the nearest opaque surface
    std::vector<ScanVeil> veils;      ///< in front of it, by sample, the nearest first
};

class ScanLines {
  public:
    /// All arguments must outlive the object.
    ScanLines(const ScanScene& scene, const ScreenView& view, const SampleGrid& grid,
              const ScanLineOptions& options);
    ~ScanLines();

    /// Renders the next scan line into `row`.
    void next(ScanRow& row);
    /// Complete after the last scan line.
    [[nodiscard]] ScanLineReport& report();

  private:
    class Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace alhazen
