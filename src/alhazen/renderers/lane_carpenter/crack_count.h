#pragma once
/// Counts samples in cracks between the polygons of patches.

#include <cstdint>

#include "alhazen/renderers/lane_carpenter/options.h"
#include "alhazen/renderers/lane_carpenter/sample_grid.h"
#include "alhazen/renderers/lane_carpenter/scan_scene.h"
#include "alhazen/renderers/lane_carpenter/screen_view.h"

namespace alhazen {

/// Number of samples of the crop that lie in cracks or overlaps between the polygons of patches
/// subdivided to `flatness`.
///
/// Conventions: both sides of an edge cross each row of samples; if they do so at different
/// columns, the samples in between are in a crack. Each edge has its own random weight, so that
/// gaps do not cancel.
[[nodiscard]] std::uint64_t count_crack_samples(const ScanScene& scene, const ScreenView& view,
                                                const SampleGrid& grid, ScanLineOptions options);

}  // namespace alhazen
