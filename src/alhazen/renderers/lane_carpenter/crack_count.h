#pragma once
/// Counts what cracks between the polygons of patches show.

#include <cstdint>

#include "alhazen/renderers/lane_carpenter/options.h"
#include "alhazen/renderers/lane_carpenter/sample_grid.h"
#include "alhazen/renderers/lane_carpenter/scan_scene.h"
#include "alhazen/renderers/lane_carpenter/screen_view.h"

namespace alhazen {

/// The samples of the crop that lie in cracks between the polygons of patches, or in overlaps,
/// where patches are subdivided to `flatness`.
///
/// Conventions: both sides of an edge cross each row of samples; where they do so at different
/// columns, the samples between are in a crack. Each edge has its own random weight, so that gaps
/// do not cancel.
[[nodiscard]] std::uint64_t count_crack_samples(const ScanScene& scene, const ScreenView& view,
                                                const SampleGrid& grid, ScanLineOptions options);

}  // namespace alhazen
