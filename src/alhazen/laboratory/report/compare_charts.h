#pragma once
/// Charts of a comparison in HTML: bars and dots on logarithmic scales, that stay readable on a
/// narrow screen and for a screen reader.

#include <string>

#include "alhazen/laboratory/compare.h"

namespace alhazen {

/// What a person calls it: the name, and the settings where they are not the defaults.
[[nodiscard]] std::string html_name(const Measurement& measurement);

/// Time for each ray, tests of primitives by kind of ray, bounds and cells by kind, seconds to
/// build, memory: a card each.
[[nodiscard]] std::string comparison_charts(const Comparison& comparison);

/// "0.000123" with three digits, and k, M or G where that is shorter.
[[nodiscard]] std::string short_number(double x);

}  // namespace alhazen
