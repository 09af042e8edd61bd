#pragma once
/// Charts of a comparison in HTML: bars and dots on logarithmic scales, readable on narrow screens
/// and by screen readers.

#include <string>

#include "alhazen/laboratory/compare.h"

namespace alhazen {

/// Display name: the name, and settings that differ from the defaults.
[[nodiscard]] std::string html_name(const Measurement& measurement);

/// Charts of time per ray, primitive tests by kind of ray, bounds and cells by kind, build seconds,
/// and memory.
[[nodiscard]] std::string comparison_charts(const Comparison& comparison);

/// The number with three digits, with a suffix k, M or G if that is shorter.
[[nodiscard]] std::string short_number(double x);

}  // namespace alhazen
