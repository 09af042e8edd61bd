#pragma once
/// Triangulates a large simple plane polygon by a sweep from left to right.
///
/// Source: Hertel, Mehlhorn, "Fast Triangulation of Simple Polygons", FCT 1983: between two edges
/// of the sweep line lies a chain of vertices that are not yet cut off, reflex on both sides of its
/// rightmost one.
/// Differs: signs are exact and vertices are ordered by x, then y, so that vertical edges need no
/// special case; only lower edges are ordered, each with the chain above it.
/// Conventions: every triangle turns left; vertices within a straight line are corners of triangles
/// like all others. Returns nothing for polygons whose self-crossings or self-contacts break the
/// sweep.
/// Complexity and threads: O(n log n) for every shape; no shared state.

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "alhazen/math/vec.h"

namespace alhazen {

/// The n - 2 triangles of the counter-clockwise loop `flat`, at least 3 finite points whose
/// products do not overflow. Nothing if the sweep finds that the polygon is not simple. Vertices
/// that repeat their neighbour get triangles without area.
[[nodiscard]] std::optional<std::vector<std::array<std::uint32_t, 3>>> triangulate_by_sweep(
    const std::vector<Vec2>& flat);

}  // namespace alhazen
