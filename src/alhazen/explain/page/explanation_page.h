#pragma once
/// An explanation as one HTML file that opens offline.
///
/// Conventions: the file is self-contained: the data are JSON, style and script are inline, the
/// picture is a data URI, and its content security policy forbids every request. Text reaches the
/// page as text only, never as markup.

#include <string>
#include <string_view>

#include "alhazen/explain/explanation.h"

namespace alhazen {

[[nodiscard]] std::string explanation_page(const Explanation& explanation);

/// The bundle of page/*.ts (scripts/page), which shows the data that are in the page, and its
/// style.
extern const std::string_view kExplanationStyle;
extern const std::string_view kExplanationScript;

}  // namespace alhazen
