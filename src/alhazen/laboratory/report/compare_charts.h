#pragma once
/// Charts of a comparison in HTML: bars and dots on logarithmic scales, readable on narrow screens
/// and by screen readers.

#include <string>

#include "alhazen/laboratory/compare.h"

namespace alhazen {

/// Display name: the name, and settings that differ from the defaults.
[[nodiscard]] std::string html_name(const Measurement& measurement);

/// One card each: time per ray, primitive tests by kind of ray, bounds and cells by kind, build
/// seconds, memory.
[[nodiscard]] std::string comparison_charts(const Comparison& comparison);

/// "0.000123" with three digits, with k, M or G where shorter.
[[nodiscard]] std::string short_number(double x);

}  // namespace alhazen
