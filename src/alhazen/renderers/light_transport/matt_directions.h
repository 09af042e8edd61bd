#pragma once
/// Diffuse directions for eight points in lanes.

#include <cstddef>
#include <span>

#include "alhazen/math/vec.h"

namespace alhazen {

inline constexpr std::size_t kMostMattDirections = 8;

/// Sets directions[i] to `cosine_direction(u[i])` (microfacets/local_directions.h), bit for bit.
/// `u`: at most kMostMattDirections, in [0, 1).
void set_matt_directions(std::span<const Vec2> u, Vec3* directions);

}  // namespace alhazen
