#pragma once
/// Memory of a scene, in total and per effective primitive.

#include <cstdint>
#include <optional>

#include "alhazen/scene/scene.h"

namespace alhazen {

/// All memory for ray tracing, with every object counted once.
[[nodiscard]] inline std::uint64_t unique_bytes(const SceneCensus& census) {
    return census.scene_bytes + census.accelerator_bytes;
}

/// Bytes per effective primitive, instances expanded. None for an empty scene; too large if the
/// count is saturated.
[[nodiscard]] inline std::optional<double> bytes_per_effective_primitive(
    const SceneCensus& census) {
    if (census.effective_primitives == 0) return {};
    return static_cast<double>(unique_bytes(census)) /
           static_cast<double>(census.effective_primitives);
}

}  // namespace alhazen
