#pragma once
/// Joins straight lines that share an end into longer ones, so that dashes continue across ends.
///
/// Conventions: lines of one style whose ends are within a hundredth of a pixel are joined; chains
/// shorter than two pixels are then omitted. Arcs are unchanged.

#include <vector>

#include "alhazen/imaging/drawing/drawing.h"

namespace alhazen {

[[nodiscard]] std::vector<DrawingLine> chained(std::vector<DrawingLine> lines);

}  // namespace alhazen
