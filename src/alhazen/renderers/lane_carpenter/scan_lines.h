#pragma once
/// Lane and Carpenter's algorithm: patches are split where the scan line meets them, and become
/// polygons where they are flat.
///
/// Source: Lane, Carpenter, Whitted and Blinn, "Scan Line Methods for Displaying Parametrically
/// Defined Surfaces", CACM 23(1), 1980; Foley, van Dam, Feiner and Hughes, "Computer Graphics:
/// Principles and Practice", 2nd ed., 1990, Fig. 15.54.
/// Differs: hidden surfaces by the depth of each sample along the spans; a patch between the
/// samples is dropped.
/// Conventions: `next` gives the scan lines of the crop from the top. Which surface is seen at a
/// sample depends neither on the order of the patches nor on the crop.
/// Complexity: O(n log n) for n polygons; memory: patches that wait below or cross the scan line.

#include <memory>
#include <span>
#include <vector>

#include "alhazen/renderers/core/reports/scan_line_report.h"
#include "alhazen/renderers/lane_carpenter/options.h"
#include "alhazen/renderers/lane_carpenter/sample_grid.h"
#include "alhazen/renderers/lane_carpenter/scan_scene.h"

namespace alhazen {

/// What is seen at a sample.
struct ScanSample {
    static constexpr std::uint32_t kNothing = 0xFFFFFFFFu;
    static constexpr std::uint32_t kFacet = 0x80000000u;  ///< bit of a facet's number

    std::uint32_t item = kNothing;  ///< number of the piece, or of the facet
    double nearness = 0;
    double u = 0, v = 0;  ///< in the unit square of the piece
};

/// A surface that may let the eye pass.
struct ScanVeil {
    std::uint32_t sample = 0;  ///< column * samples + number in the pixel
    ScanSample seen;
};

struct ScanRow {
    std::vector<ScanSample> samples;  ///< [column][sample]: the nearest that lets nothing pass
    std::vector<ScanVeil> veils;      ///< before it, by sample, the nearest first
};

class ScanLines {
  public:
    /// All must outlive the object.
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
