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

/// "UTF-16" or "UTF-32" if the text begins with a mark of it, or without a mark as ASCII does in
/// it; else null.
[[nodiscard]] inline const char* wide_encoding(std::string_view text) {
    using namespace std::string_view_literals;
    if (text.starts_with("\xFF\xFE\0\0"sv) || text.starts_with("\0\0\xFE\xFF"sv)) return "UTF-32";
    if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF")) return "UTF-16";
    if (text.size() < 4) return nullptr;
    std::string form;  // of the first four bytes: 'a' for text of ASCII, '0' for a zero
    for (const char c : text.substr(0, 4)) {
        const bool is_text = (c >= ' ' && c <= '~') || (c >= '\t' && c <= '\r');
        form += is_text ? 'a' : c == '\0' ? '0' : '?';
    }
    if (form == "a0a0" || form == "0a0a") return "UTF-16";
    return form == "a000" || form == "000a" ? "UTF-32" : nullptr;
}
/// The message about text of a wide encoding.
[[nodiscard]] inline std::string wide_encoding_found(const char* encoding) {
    return std::string("the file is ") + encoding + " text; expected ASCII or UTF-8";
}
/// Throws Error (Scene) for text of a wide encoding.
inline void refuse_wide_text(std::string_view text, const std::string& file) {
    if (const char* const encoding = wide_encoding(text)) {
        throw Error(ErrorKind::Scene, wide_encoding_found(encoding), {file, 1, 1});
    }
}
/// The same as a finding; returns whether there is one.
[[nodiscard]] inline bool report_wide_text(std::string_view text, const std::string& file,
                                           Diagnostics& diagnostics) {
    const char* const encoding = wide_encoding(text);
    if (encoding != nullptr) diagnostics.error({file, 1, 1}, wide_encoding_found(encoding));
    return encoding != nullptr;
}

}  // namespace alhazen
