#pragma once
/// Joins straight lines that share an end into longer ones, so that dashes run through.
///
/// Conventions: lines of one style whose ends are within a hundredth of a pixel are joined; what is
/// shorter than two pixels then is left out. Arcs stay as they are.

#include <vector>

#include "alhazen/imaging/drawing/drawing.h"

namespace alhazen {

[[nodiscard]] std::vector<DrawingLine> chained(std::vector<DrawingLine> lines);

}  // namespace alhazen
