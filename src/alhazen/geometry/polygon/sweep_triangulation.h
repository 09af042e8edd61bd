#pragma once
/// Cuts a large simple polygon of the plane into triangles, by a sweep from left to right.
///
/// Source: Hertel, Mehlhorn, "Fast Triangulation of Simple Polygons", FCT 1983: between two edges
/// of the sweep line runs a chain of vertices that are not yet cut off, reflex on both sides of its
/// rightmost one.
/// Differs: signs are exact and vertices are ordered by x, then y, so that vertical edges are no
/// special case; only lower edges are ordered, each with the chain above it.
/// Conventions: every triangle turns left; vertices in the middle of a straight line are ends of
/// triangles like all others. Polygons that cross or touch themselves are noticed where they break
/// the sweep: nothing is returned.
/// Complexity and threads: O(n log n) whatever the shape; no state shared.

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "alhazen/math/vec.h"

namespace alhazen {

/// n - 2 triangles of the loop `flat`, counter-clockwise, at least 3 finite points whose products
/// do not overflow. Nothing when the sweep meets what a simple polygon does not have. Vertices that
/// repeat their neighbour are in triangles without area.
[[nodiscard]] std::optional<std::vector<std::array<std::uint32_t, 3>>> triangulate_by_sweep(
    const std::vector<Vec2>& flat);

}  // namespace alhazen
