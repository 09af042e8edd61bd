#pragma once
/// The kinds of bound by name, as in `--bound`.

#include <cstdint>

#include "alhazen/accel/core/accelerator_settings.h"

namespace alhazen {

enum class BoundKind : std::uint8_t { Sphere, Ellipsoid, Box, Slabs3, Slabs7, Slabs13 };

/// Names in the order of the enumeration; `slabs3` is a box specified by its slabs.
inline constexpr const char* kBoundNames[] = {"sphere", "ellipsoid", "box",
                                              "slabs3", "slabs7",    "slabs13"};

[[nodiscard]] inline BoundKind read_bound(SettingsReader& reader, BoundKind fallback) {
    return static_cast<BoundKind>(reader.choice("bound", "bound of primitives",
                                                static_cast<std::size_t>(fallback), kBoundNames));
}

/// For hierarchies, without ellipsoids: their unions are not tight.
inline constexpr const char* kNestingBoundNames[] = {"sphere", "box", "slabs7", "slabs13"};
enum class NestingBound : std::uint8_t { Sphere, Box, Slabs7, Slabs13 };

[[nodiscard]] inline NestingBound read_nesting_bound(SettingsReader& reader,
                                                     NestingBound fallback) {
    return static_cast<NestingBound>(reader.choice("bound", "bound of primitives and nodes",
                                                   static_cast<std::size_t>(fallback),
                                                   kNestingBoundNames));
}

}  // namespace alhazen
