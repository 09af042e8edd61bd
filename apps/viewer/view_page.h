#pragma once
/// The files of the viewer's page, embedded in the program.

#include <string_view>
#include <vector>

#include "http_server.h"

namespace alhazen {

// Generated from page/ by the build.
extern const std::string_view kViewPage;
extern const std::string_view kViewScript;
extern const std::string_view kViewStyle;

namespace viewer {

[[nodiscard]] std::vector<Asset> view_page();

}  // namespace viewer
}  // namespace alhazen
