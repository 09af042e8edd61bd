#pragma once
/// The files of the viewer's page, embedded in the program.

#include <vector>

#include "alhazen/base/embedded_text.h"
#include "http_server.h"

namespace alhazen {

// Generated from page/ by the build.
extern const EmbeddedText kViewPage;
extern const EmbeddedText kViewScript;
extern const EmbeddedText kViewStyle;

namespace viewer {

[[nodiscard]] std::vector<Asset> view_page();

}  // namespace viewer
}  // namespace alhazen
