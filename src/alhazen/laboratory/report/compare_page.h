#pragma once
/// A comparison as one HTML file for a person: pictures, cost heat maps, charts, a table
/// (docs/reference/compare.md).
///
/// Conventions: the file needs nothing else: pictures are data URIs, style and script are inside,
/// and its content security policy forbids every request. Without a script all is there, but the
/// table is not sorted and the viewer does not move. Costs of all accelerators of a scene share one
/// logarithmic scale.

#include <span>
#include <string>

#include "alhazen/laboratory/compare.h"

namespace alhazen {

[[nodiscard]] std::string comparison_page(std::span<const Comparison> comparisons);

}  // namespace alhazen
