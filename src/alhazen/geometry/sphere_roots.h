#pragma once
/// The ray-sphere intersection, for double and for lanes of double.
///
/// Source: Haines, Günther and Akenine-Möller, "Precision Improvements for Ray/Sphere
/// Intersection", Ray Tracing Gems, 2019, ch. 7: the discriminant from the distance of the centre
/// to the line, so that far origins do not cancel; the second root from the product of the roots.
/// Differs: the direction need not be unit; the magnitude of the second root is bounded by that of
/// the first. Uses only + - * / and square root, correctly rounded and never fused, so lanes give
/// the bits of the scalar code.

#include <cmath>

#include "alhazen/math/vec.h"

namespace alhazen {

#include "alhazen/geometry/fast_min_max-inl.h"
#include "alhazen/geometry/sphere_roots_formula-inl.h"

}  // namespace alhazen
