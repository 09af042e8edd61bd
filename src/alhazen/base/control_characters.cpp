#include "alhazen/base/control_characters.h"

namespace alhazen {

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
        const auto next = static_cast<unsigned char>(i + 1 < text.size() ? text[i + 1] : 0);
        if (c == '\n' && newlines == Newlines::Keep) {
            result += '\n';
        } else if (c < 0x20 || c == 0x7f) {
            append(c);
        } else if (c == 0xc2 && next >= 0x80 && next < 0xa0) {
            append(c);
            append(next);
            ++i;
        } else {
            result += text[i];
        }
    }
    return result;
}

}  // namespace alhazen
