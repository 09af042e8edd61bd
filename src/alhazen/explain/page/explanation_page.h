#pragma once
/// An explanation as one HTML file that can be opened offline.
///
/// Conventions: the file is self-contained: data are JSON, style and script are inline, the picture
/// is a data URI, and its content security policy forbids every request. Text is inserted as text
/// only, never as markup.

#include <string>

#include "alhazen/base/embedded_text.h"
#include "alhazen/explain/explanation.h"

namespace alhazen {

[[nodiscard]] std::string explanation_page(const Explanation& explanation);

/// Style and script (the bundle of page/*.ts made by scripts/page), which show the data in the
/// page.
extern const EmbeddedText kExplanationStyle;
extern const EmbeddedText kExplanationScript;

}  // namespace alhazen
