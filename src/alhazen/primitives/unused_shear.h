#pragma once
/// A placeholder for the shear argument of shape tests, which only triangles use.
///
/// Conventions: outside all target namespaces, so that its construction needs no instruction set.

#include "alhazen/geometry/watertight_triangle.h"

namespace alhazen {

inline const RayShear kUnusedShear(Vec3{0, 0, 1});

}  // namespace alhazen
