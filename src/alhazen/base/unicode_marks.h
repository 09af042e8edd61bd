#pragma once
/// Byte order marks of Unicode texts. All text formats are ASCII or UTF-8; YAML may be UTF-16, too.

#include <string>
#include <string_view>

#include "alhazen/base/diagnostics.h"

namespace alhazen {

/// The text without the mark of UTF-8, which carries no information.
[[nodiscard]] inline std::string_view without_byte_order_mark(std::string_view text) {
    if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
    return text;
}

/// True if the text begins with a mark of UTF-16.
[[nodiscard]] inline bool is_utf16(std::string_view text) {
    return text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF");
}
inline constexpr const char* kUtf16Found = "the file is UTF-16 text; expected ASCII or UTF-8";
/// Throws Error (Scene) for UTF-16 text.
inline void refuse_utf16(std::string_view text, const std::string& file) {
    if (is_utf16(text)) throw Error(ErrorKind::Scene, kUtf16Found, {file, 1, 1});
}
/// The same as a finding; returns whether there is one.
[[nodiscard]] inline bool report_utf16(std::string_view text, const std::string& file,
                                       Diagnostics& diagnostics) {
    if (is_utf16(text)) diagnostics.error({file, 1, 1}, kUtf16Found);
    return is_utf16(text);
}

}  // namespace alhazen
