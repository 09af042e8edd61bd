#pragma once
/// Current size of the acceleration structures of a scene.
///
/// Conventions: every aggregate counts once, however often it is placed. Right after compilation
/// this is `SceneCensus::accelerator_bytes`; it grows while rays are traced through accelerators
/// that build lists on demand.

#include <cstdint>

#include "alhazen/primitives/aggregate.h"

namespace alhazen {

/// Bytes of the aggregate and of all aggregates placed in it, to any depth.
[[nodiscard]] std::uint64_t accelerator_bytes(const Aggregate& aggregate);

}  // namespace alhazen
