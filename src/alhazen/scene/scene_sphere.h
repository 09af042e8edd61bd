#pragma once
/// A sphere around all of a scene that is bounded.

#include "alhazen/geometry/bounds_source.h"
#include "alhazen/scene/scene.h"

namespace alhazen {

/// Around the boxes of all bounded primitives; of radius sqrt(3) around the origin where there are
/// none. The radius is above 0. Complexity: O(1), O(primitives) where some are unbounded.
[[nodiscard]] BoundingSphere sphere_around_bounded(const Scene& scene);

/// Whether some primitive is unbounded.
[[nodiscard]] bool reaches_infinity(const Scene& scene);

}  // namespace alhazen
