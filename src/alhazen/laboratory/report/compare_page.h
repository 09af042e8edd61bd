#pragma once
/// A comparison as one HTML file with pictures, cost heat maps, charts and a table
/// (docs/reference/compare.md).
///
/// Conventions: the file is self-contained: pictures are data URIs, style and script are inline,
/// and its content security policy forbids every request. Without scripts everything is visible,
/// but the table cannot be sorted and the viewer is static. Costs of all accelerators of a scene
/// share one logarithmic scale.

#include <span>
#include <string>

#include "alhazen/laboratory/compare.h"

namespace alhazen {

[[nodiscard]] std::string comparison_page(std::span<const Comparison> comparisons);

}  // namespace alhazen
