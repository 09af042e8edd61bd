#pragma once
/// What a scene costs in memory beside what rays see of it.

#include <cstdint>
#include <optional>

#include "alhazen/scene/scene.h"

namespace alhazen {

/// All that is stored for rays, every object once.
[[nodiscard]] inline std::uint64_t unique_bytes(const SceneCensus& census) {
    return census.scene_bytes + census.accelerator_bytes;
}

/// For each primitive as rays see them, instances multiplied out. None in an empty scene; too large
/// where the count of these is saturated.
[[nodiscard]] inline std::optional<double> bytes_per_effective_primitive(
    const SceneCensus& census) {
    if (census.effective_primitives == 0) return {};
    return static_cast<double>(unique_bytes(census)) /
           static_cast<double>(census.effective_primitives);
}

}  // namespace alhazen
