#pragma once
/// A sphere around the bounded part of a scene.

#include "alhazen/geometry/bounds_source.h"
#include "alhazen/scene/scene.h"

namespace alhazen {

/// A sphere around the boxes of all bounded primitives while the shutter is open, those in
/// instances included; of radius sqrt(3) around the origin if there are none. The radius is
/// positive. Complexity: O(1); O(primitives) of the aggregates that are unbounded.
[[nodiscard]] BoundingSphere sphere_around_bounded(const Scene& scene);

/// True if some primitive is unbounded.
[[nodiscard]] bool reaches_infinity(const Scene& scene);

}  // namespace alhazen
