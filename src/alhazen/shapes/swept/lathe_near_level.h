#pragma once
/// The crossings of a lathe with a ray that hardly climbs: with flat ends, which it may graze, and
/// with sides, on which it stays at nearly one height.
///
/// Source: Kajiya's curves, see lathe.h; Ramshaw, "Blossoms are polar forms", CAGD 6, 1989 (the
/// control points of a piece of a curve).
/// Differs: the height of a point of the profile is counted in the ray's t, from where the ray is
/// nearest to the axis. So a flat end is where it is to the last digit, however slowly the ray
/// comes near it. The numbers of a side then are huge but for a short piece, and outside of that
/// piece the ray is farther from the axis than the profile: only such pieces are searched, in
/// double-double. At ends of curves the sign is that of the point there, one for all curves that
/// share it.
/// Complexity: O(curves), some microseconds each; rays of this kind are rare.

#include "alhazen/shapes/swept/lathe.h"

namespace alhazen {

/// Appends all crossings of the line, in any order: t, the parameter of the curve as u, the curve
/// as part. Precondition: the ray climbs, by 2^-60 of its way at least.
void near_level_crossings(const Lathe& lathe, const Ray& ray, ShapeHits& found);

}  // namespace alhazen
