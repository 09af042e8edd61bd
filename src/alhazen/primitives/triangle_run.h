#pragma once
/// The box of many triangles, compiled for several instruction sets: one register for a point.
///
/// Conventions: results do not depend on the instruction set.

#include <array>
#include <cstddef>
#include <cstdint>

#include "alhazen/primitives/triangle_bounds.h"

namespace alhazen {

/// Triangles of one mesh.
struct TriangleRun {
    const Vec3* positions;
    const std::array<std::uint32_t, 3>* triangles;
    std::size_t count;
};

/// Includes the triangles that have a box, as TriangleBounds, in `all`. True if all of them have.
using IncludeRun = bool (*)(const TriangleRun& run, TriangleBounds& all);
/// That of this machine.
[[nodiscard]] IncludeRun include_run();

}  // namespace alhazen
