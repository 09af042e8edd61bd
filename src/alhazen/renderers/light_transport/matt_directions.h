#pragma once
/// Directions of matt surfaces for eight points in lanes.

#include <cstddef>
#include <span>

#include "alhazen/math/vec.h"

namespace alhazen {

inline constexpr std::size_t kMostMattDirections = 8;

/// directions[i] is `cosine_direction(u[i])` (microfacets/local_directions.h), bit for bit; at most
/// kMostMattDirections. u in [0, 1).
void set_matt_directions(std::span<const Vec2> u, Vec3* directions);

}  // namespace alhazen
