#pragma once
/// What the acceleration structures of a scene hold now.
///
/// Conventions: every aggregate once, however often it is placed. Right after the scene was
/// compiled this is `SceneCensus::accelerator_bytes`; it grows while rays are traced through
/// accelerators that make their lists as rays come.

#include <cstdint>

#include "alhazen/primitives/aggregate.h"

namespace alhazen {

/// Of the aggregate and of all that are placed in it, to any depth.
[[nodiscard]] std::uint64_t accelerator_bytes(const Aggregate& aggregate);

}  // namespace alhazen
