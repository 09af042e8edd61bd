#pragma once
/// A surface below a thin sheet at its place, as one surface.
///
/// Source: Stokes, "On the Intensity of the Light Reflected from or Transmitted through a Pile of
/// Plates", 1862.
/// Conventions: the sheet is seen first, or behind the surface. Light is reflected between the two
/// any number of times in mirror directions; once, where one of them scatters it.

#include "alhazen/renderers/core/local_shading.h"

namespace alhazen {

/// Changes the sample and `passing` of a completed point to those below or before the sheet. The
/// sheet is evaluated and turned to the ray. Each has its own highlight; where both mirror, lobes
/// have the shape of the surface's.
void lay_below(const MaterialSample& sheet, bool sheet_is_behind, ShadingPoint& point);

/// True if the sheets at the place of the surface lie behind it: they are outside of solids.
[[nodiscard]] inline bool hides_sheets(const Scene& scene, const ShadingPoint& point) {
    return !point.entering && point.passing.is_black() && scene.is_closed(point.surface.part);
}

}  // namespace alhazen
