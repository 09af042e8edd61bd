#pragma once
/// The outline of a profile without what coincides in pairs.
///
/// Source: Hierholzer, "Über die Möglichkeit, einen Linienzug ohne Wiederholung und ohne
/// Unterbrechung zu umfahren", Mathematische Annalen 6, 1873 (a graph of even degrees is covered by
/// closed trails).
/// Differs: trails that touch themselves are left as they are found.
/// Conventions: two curves that coincide have the same, inside or outside, on both sides: they
/// bound nothing, but are met by rays, one just before or after the other. Lines coincide where
/// they lie on one line, exactly (math/odd_segments.h); cubics if they have the same control
/// points, in either direction.

#include "alhazen/shapes/swept/profile.h"

namespace alhazen {

/// Removes the parts of curves that an even number of curves share, and joins what is left in new
/// loops; a profile without such parts stays as it is. The odd-even inside remains, and so do the
/// bounds if nothing is left. Every loop must close, or begin and end on the axis x = 0; this holds
/// for the new loops.
void remove_shared_parts(Profile& profile);

}  // namespace alhazen
