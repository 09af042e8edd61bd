#pragma once
/// Counts, area, flux volume and boundary of Bezier patches, bilinear patches and patch meshes.
///
/// Conventions: the flux volume is positive where du x dv points outward; for a closed surface it
/// is the enclosed volume.

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "alhazen/scene_model/scene_description.h"

namespace alhazen {

/// Surfaces of more patches are measured only on request.
inline constexpr std::size_t kMaxMeasuredPatches = 20'000;

struct PatchFigures {
    std::size_t patches = 0, control_points = 0;
    std::optional<double> area, flux_volume;  ///< none: not measured
    std::optional<bool> closed;               ///< none: not tested
    /// Boundary curves that are more than a point and belong to an odd number of patches; none: not
    /// counted.
    std::optional<std::size_t> open_curves;
    /// Ends of the first few of these curves.
    std::vector<std::array<Vec3, 2>> first_open;
};

/// None for shapes that are not patches. `measure`: also area, flux volume and boundary curves. The
/// shape must be valid.
[[nodiscard]] std::optional<PatchFigures> patch_figures(const AnyShape& shape, bool measure);

}  // namespace alhazen
