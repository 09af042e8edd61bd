#pragma once
/// Visible surfaces in scan lines: patches are split where a scan line meets them.
///
/// Source: Lane, Carpenter, Whitted and Blinn, "Scan Line Methods for Displaying Parametrically
/// Defined Surfaces", CACM 23(1), 1980 (`lane_carpenter`); Clark, "A Fast Scan-Line Algorithm for
/// Rendering Parametric Surfaces", SIGGRAPH 1979 (`clark`: all patches are subdivided first, and
/// straight edges stay straight).
/// Differs: shading and layers are those of `ray_casting`.
/// Conventions: geometry is read from RenderJob::description. Scan lines are shaded in parallel;
/// pixels and counts are independent of the threads.

#include "alhazen/renderers/core/renderer.h"
#include "alhazen/renderers/lane_carpenter/options.h"

namespace alhazen {

class LaneCarpenter final : public Renderer {
  public:
    explicit LaneCarpenter(const ScanLineOptions& options = {}) : options_(options) {}

    /// Throws Error (Usage) naming the parts of the scene that are neither patches nor polygons.
    [[nodiscard]] RenderReport render(const RenderJob& job, Film& film) const override;
    [[nodiscard]] bool needs_aggregate() const override { return false; }
    [[nodiscard]] bool reflects() const override { return false; }
    [[nodiscard]] bool takes_wide_cameras() const override { return false; }
    [[nodiscard]] bool has_scan_lines() const override { return true; }

  private:
    ScanLineOptions options_;
};

}  // namespace alhazen
