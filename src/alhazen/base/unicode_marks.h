#pragma once
/// Byte order marks of Unicode texts. All text formats are ASCII or UTF-8.

#include <string_view>

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

}  // namespace alhazen
