#pragma once
/// The tables of a renderer in scan lines, drawn as an animated SVG page: patches that wait in the
/// buckets, the active-patch table and the polygon table at each scan line.
///
/// Source: Foley, van Dam, Feiner and Hughes, "Computer Graphics: Principles and Practice", 2nd
/// ed., 1990, Fig. 15.54 (the tables).
/// Conventions: scan lines run downward, as in the picture; a line runs over them, and bars show
/// the tables at it. Without animation the curves are complete.

#include <string>

#include "alhazen/renderers/core/reports/scan_line_report.h"

namespace alhazen {

[[nodiscard]] std::string scan_line_svg(const ScanLineReport& report, const std::string& title);

}  // namespace alhazen
