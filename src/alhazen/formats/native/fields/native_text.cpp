#include "alhazen/formats/native/fields/native_text.h"

#include <charconv>
#include <cmath>

#include "alhazen/base/error.h"

namespace alhazen {

namespace {

template <class Number>
std::string digits_of(Number number) {
    char buffer[32];
    const auto [end, status] = std::to_chars(std::begin(buffer), std::end(buffer), number);
    (void)status;  // no double needs more than 24 characters
    return {buffer, end};
}

/// (a, b, c)
template <class... Number>
std::string tuple(const Number&... numbers) {
    std::string text = "(";
    ((text += text.size() == 1 ? native_value(numbers) : ", " + native_value(numbers)), ...);
    return text + ")";
}

}  // namespace

std::string native_value(double number) {
    if (!std::isfinite(number)) {
        throw Error(ErrorKind::Scene, "a number that is not finite cannot be written to a scene");
    }
    return digits_of(number);
}

std::string native_value(int number) {
    return digits_of(number);
}

std::string native_value(bool truth) {
    return truth ? "true" : "false";
}

std::string native_value(const Vec2& v) {
    return tuple(v.x, v.y);
}

std::string native_value(const Vec3& v) {
    return tuple(v.x, v.y, v.z);
}

std::string native_value(const Rgb& color) {
    return tuple(color.r, color.g, color.b);
}

std::string native_value(const Affine& transform) {
    const auto& [x, y, z] = transform.linear;
    const Vec3& t = transform.translation;
    return "matrix(" + tuple(x.x, y.x, z.x, t.x) + ", " + tuple(x.y, y.y, z.y, t.y) + ", " +
           tuple(x.z, y.z, z.z, t.z) + ")";
}

std::string native_value(const std::vector<TransformKey>& keys) {
    return native_list_of(keys, [](const TransformKey& key) {
        return "(" + native_value(key.time) + ", " + native_value(key.outer_from_inner) + ")";
    });
}

std::string native_string(std::string_view text) {
    constexpr const char* kHex = "0123456789abcdef";
    std::string out = "\"";
    for (const char c : text) {
        const auto byte = static_cast<unsigned char>(c);
        if (c == '"' || c == '\\') {
            out += '\\';
            out += c;
        } else if (c == '\n') {
            out += "\\n";
        } else if (byte < 0x20 || byte == 0x7F) {
            out += "\\x";
            out += kHex[byte >> 4];
            out += kHex[byte & 15];
        } else {
            out += c;
        }
    }
    return out + "\"";
}

std::string native_list(const std::vector<std::string>& values) {
    std::string text = "[";
    for (const std::string& value : values) {
        if (text.size() > 1) text += ", ";
        text += value;
    }
    return text + "]";
}

NativeBlockText::NativeBlockText(std::string_view type, std::string_view label) : head_(type) {
    if (!label.empty()) head_ += " " + native_string(label);
}

std::string NativeBlockText::text(int indent) const {
    constexpr std::size_t kLine = 160;
    const std::string margin(static_cast<std::size_t>(indent), ' ');
    std::size_t length = head_.size();
    bool one_line = true;
    for (const auto& [key, value] : pairs_) {
        length += key.size() + value.size() + 5;
        one_line = one_line && value.find('\n') == std::string::npos;
    }
    one_line = one_line && length <= kLine;
    std::string out = margin + head_ + (head_.empty() ? "{" : " {");
    const std::string separator = one_line ? " " : "\n" + margin + "    ";
    bool first = true;
    for (const auto& [key, value] : pairs_) {
        if (one_line && !first) out += ';';
        first = false;
        out += separator + key + " = " + value;
    }
    return out + (one_line ? " }" : "\n" + margin + "}");
}

}  // namespace alhazen
