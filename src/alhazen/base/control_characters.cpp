#include "alhazen/base/control_characters.h"

namespace alhazen {

namespace {

bool is_between(unsigned char low, unsigned char c, unsigned char high) {
    return low <= c && c <= high;
}

/// Number of bytes of the character beyond ASCII that `text` begins with; 0 if it is not
/// well-formed.
std::size_t character_length(std::string_view text) {
    const auto at = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
    const unsigned char lead = at(0);
    const std::size_t length = is_between(0xc2, lead, 0xdf)   ? 2
                               : is_between(0xe0, lead, 0xef) ? 3
                               : is_between(0xf0, lead, 0xf4) ? 4
                                                              : 0;
    if (length == 0 || text.size() < length) return 0;
    // Excludes overlong forms, surrogates and numbers above U+10FFFF.
    const unsigned char low = lead == 0xe0 ? 0xa0 : lead == 0xf0 ? 0x90 : 0x80;
    const unsigned char high = lead == 0xed ? 0x9f : lead == 0xf4 ? 0x8f : 0xbf;
    if (!is_between(low, at(1), high)) return 0;
    for (std::size_t i = 2; i < length; ++i) {
        if (!is_between(0x80, at(i), 0xbf)) return 0;
    }
    return length;
}

}  // namespace

std::string escape_controls(std::string_view text, Newlines newlines) {
    static constexpr char kDigits[] = "0123456789abcdef";
    std::string result;
    result.reserve(text.size());
    const auto append = [&](unsigned char c) {
        result += "\\x";
        result += kDigits[c >> 4];
        result += kDigits[c & 15];
    };
    for (std::size_t i = 0; i < text.size(); ++i) {
        const auto c = static_cast<unsigned char>(text[i]);
        if (c == '\n' && newlines == Newlines::Keep) {
            result += '\n';
        } else if (c < 0x20 || c == 0x7f) {
            append(c);
        } else if (c < 0x80) {
            result += text[i];
        } else {
            const std::size_t length = character_length(text.substr(i));
            const bool is_control =
                c == 0xc2 && length == 2 && static_cast<unsigned char>(text[i + 1]) < 0xa0;
            if (length == 0 || is_control) {
                append(c);
                if (is_control) append(static_cast<unsigned char>(text[++i]));
            } else {
                result += text.substr(i, length);
                i += length - 1;
            }
        }
    }
    return result;
}

}  // namespace alhazen
