#pragma once
/// Escapes control characters in text from files, which a terminal would interpret; a NUL would end
/// a message.
///
/// Conventions: escapes the control characters of ASCII and those of UTF-8 beyond ASCII (U+0080 to
/// U+009F), each byte as \x1b. All other bytes are kept, well-formed UTF-8 or not.

#include <string>
#include <string_view>

namespace alhazen {

enum class Newlines { Escape, Keep };

[[nodiscard]] std::string escape_controls(std::string_view text,
                                          Newlines newlines = Newlines::Escape);

}  // namespace alhazen
