#pragma once
/// Memory of the acceleration structures of a scene.
///
/// Conventions: every aggregate counts once, however often it is placed. After compilation this is
/// `SceneCensus::accelerator_bytes`; it grows with tracing for accelerators that build lists on
/// demand.

#include <cstdint>

#include "alhazen/primitives/aggregate.h"

namespace alhazen {

/// Current size in bytes of the aggregate and of all aggregates placed in it, to any depth.
[[nodiscard]] std::uint64_t accelerator_bytes(const Aggregate& aggregate);

}  // namespace alhazen
