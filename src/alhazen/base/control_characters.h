#pragma once
/// Escapes control characters in text from files: a terminal interprets them, and a NUL ends a
/// message.
///
/// Conventions: escapes the control characters of ASCII and those of UTF-8 beyond it (U+0080 to
/// U+009F), each byte as \x1b. All other bytes stay, well-formed UTF-8 or not.

#include <string>
#include <string_view>

namespace alhazen {

enum class Newlines { Escape, Keep };

[[nodiscard]] std::string escape_controls(std::string_view text,
                                          Newlines newlines = Newlines::Escape);

}  // namespace alhazen
