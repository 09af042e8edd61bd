#pragma once
/// The one ray-sphere solution of the system, for double and for lanes of double alike.
///
/// Source: Haines, Günther and Akenine-Möller, "Precision Improvements for Ray/Sphere
/// Intersection", Ray Tracing Gems, 2019, ch. 7: the discriminant from the distance of the centre
/// to the line, so that far origins do not cancel; the second root from the product of the roots.
/// Differs: the direction need not be unit; the second root is held to the size of the first. Only
/// + - * / and square root, all correctly rounded and never fused, so a block of lanes gives the
/// bits of the scalar.

#include <cmath>

#include "alhazen/math/vec.h"

namespace alhazen {

#include "alhazen/geometry/fast_min_max-inl.h"
#include "alhazen/geometry/sphere_roots_formula-inl.h"

}  // namespace alhazen
