#pragma once
/// The tables of a scan-line renderer as an animated SVG page: the patches waiting in the buckets,
/// the active-patch table and the polygon table at each scan line.
///
/// Source: Foley, van Dam, Feiner and Hughes, "Computer Graphics: Principles and Practice", 2nd
/// ed., 1990, Fig. 15.54 (the tables).
/// Conventions: scan lines run downward, as in the picture; a line moves over them, and bars show
/// the sizes of the tables at it. Without animation the curves are complete.

#include <string>

#include "alhazen/renderers/core/reports/scan_line_report.h"

namespace alhazen {

[[nodiscard]] std::string scan_line_svg(const ScanLineReport& report, const std::string& title);

}  // namespace alhazen
