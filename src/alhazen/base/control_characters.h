#pragma once
/// Text from files, made safe to show: a terminal obeys control characters, and a NUL would cut a
/// message.
///
/// Conventions: what is escaped are the control characters of ASCII and those beyond it in UTF-8
/// (U+0080 to U+009F), each byte as \x1b. Everything else stays, well-formed UTF-8 or not.

#include <string>
#include <string_view>

namespace alhazen {

enum class Newlines { Escape, Keep };

[[nodiscard]] std::string escape_controls(std::string_view text,
                                          Newlines newlines = Newlines::Escape);

}  // namespace alhazen
