#pragma once
/// Escapes control characters in text from files, which a terminal would interpret (a NUL would end
/// a message), and bytes that are not UTF-8, which programs that read messages refuse.
///
/// Source: RFC 3629, "UTF-8, a transformation format of ISO 10646", 2003, section 4.
/// Conventions: escapes the control characters of ASCII and those of UTF-8 beyond ASCII (U+0080 to
/// U+009F), and bytes outside well-formed UTF-8, each byte as \x1b. All other bytes are kept.

#include <string>
#include <string_view>

namespace alhazen {

enum class Newlines { Escape, Keep };

[[nodiscard]] std::string escape_controls(std::string_view text,
                                          Newlines newlines = Newlines::Escape);

}  // namespace alhazen
