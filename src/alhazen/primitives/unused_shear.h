#pragma once
/// A placeholder shear for tests of shapes, which do not use it.
///
/// Conventions: outside of all target namespaces, so that no instruction set is needed to construct
/// it.

#include "alhazen/geometry/watertight_triangle.h"

namespace alhazen {

/// Used by triangles only.
inline const RayShear kUnusedShear(Vec3{0, 0, 1});

}  // namespace alhazen
