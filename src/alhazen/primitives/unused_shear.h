#pragma once
/// The shear that tests of shapes are given, which do not look at it.
///
/// Conventions: outside of all target namespaces, so that no instruction set is needed to make it.

#include "alhazen/geometry/watertight_triangle.h"

namespace alhazen {

/// Only triangles look at it.
inline const RayShear kUnusedShear(Vec3{0, 0, 1});

}  // namespace alhazen
