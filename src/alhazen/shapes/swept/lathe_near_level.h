#pragma once
/// The crossings of a lathe with a nearly level ray: with flat ends, which it may graze, and with
/// sides, along which its height is nearly constant.
///
/// Source: Kajiya's curves, see lathe.h; Ramshaw, "Blossoms are polar forms", CAGD 6, 1989 (the
/// control points of a piece of a curve).
/// Differs: the height of a point of the profile is measured in the ray's t, from the point nearest
/// to the axis. The position of a flat end is thus accurate to the last digit for any climb of the
/// ray. The values on a side are huge except on a short piece; elsewhere the ray is farther from
/// the axis than the profile. Only these pieces are searched, in double-double. At ends of curves
/// the sign is that of the point there, the same for all curves that share it.
/// Complexity: O(curves), some microseconds each; rays of this kind are rare.

#include "alhazen/shapes/swept/lathe.h"

namespace alhazen {

/// Appends all crossings of the line, in any order: t, the parameter of the curve as u, the curve
/// as part. Precondition: the climb of the ray is at least 2^-60 of its length.
void near_level_crossings(const Lathe& lathe, const Ray& ray, ShapeHits& found);

}  // namespace alhazen
