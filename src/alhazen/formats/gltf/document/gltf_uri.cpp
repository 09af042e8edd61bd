#include "alhazen/formats/gltf/document/gltf_uri.h"

#include <array>
#include <cstdint>

namespace alhazen::gltf {

namespace {

constexpr std::string_view kAlphabet =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
constexpr std::uint8_t kNoDigit = 255;

constexpr std::array<std::uint8_t, 256> make_digits() {
    std::array<std::uint8_t, 256> digits{};
    for (std::uint8_t& digit : digits) digit = kNoDigit;
    for (std::size_t i = 0; i < kAlphabet.size(); ++i) {
        digits[static_cast<unsigned char>(kAlphabet[i])] = static_cast<std::uint8_t>(i);
    }
    // RFC 4648, section 5: the URL-safe alphabet.
    digits[static_cast<unsigned char>('-')] = 62;
    digits[static_cast<unsigned char>('_')] = 63;
    return digits;
}
constexpr std::array<std::uint8_t, 256> kDigits = make_digits();

int hex_digit(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return -1;
}

bool is_letter(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}
bool is_scheme_character(char c) {
    return is_letter(c) || (c >= '0' && c <= '9') || c == '+' || c == '-' || c == '.';
}

char lower(char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}
bool begins_with(std::string_view text, std::string_view lower_case) {
    if (text.size() < lower_case.size()) return false;
    for (std::size_t i = 0; i < lower_case.size(); ++i) {
        if (lower(text[i]) != lower_case[i]) return false;
    }
    return true;
}

}  // namespace

bool is_data_uri(std::string_view uri) {
    return begins_with(uri, "data:");
}

bool is_absolute_uri(std::string_view uri) {
    if (!uri.empty() && (uri[0] == '/' || uri[0] == '\\')) return true;
    if (uri.empty() || !is_letter(uri[0])) return false;
    std::size_t i = 1;
    while (i < uri.size() && is_scheme_character(uri[i])) ++i;
    return i < uri.size() && uri[i] == ':';
}

std::optional<std::string> percent_decoded(std::string_view uri) {
    std::string out;
    out.reserve(uri.size());
    for (std::size_t i = 0; i < uri.size(); ++i) {
        if (uri[i] != '%') {
            out += uri[i];
            continue;
        }
        if (uri.size() - i < 3) return std::nullopt;
        const int high = hex_digit(uri[i + 1]), low = hex_digit(uri[i + 2]);
        if (high < 0 || low < 0) return std::nullopt;
        out += static_cast<char>(16 * high + low);
        i += 2;
    }
    return out;
}

std::optional<std::string> base64_decoded(std::string_view text) {
    if (text.size() % 4 == 0) {
        for (int i = 0; i < 2 && !text.empty() && text.back() == '='; ++i) text.remove_suffix(1);
    }
    if (text.size() % 4 == 1) return std::nullopt;
    std::string out;
    out.reserve(text.size() / 4 * 3 + 2);
    std::uint32_t bits = 0;
    int count = 0;
    for (const char c : text) {
        const std::uint8_t digit = kDigits[static_cast<unsigned char>(c)];
        if (digit == kNoDigit) return std::nullopt;
        bits = (bits << 6) | digit;
        count += 6;
        if (count >= 8) {
            count -= 8;
            out += static_cast<char>((bits >> count) & 0xFF);
        }
    }
    return out;
}

std::optional<DataUri> read_data_uri(std::string_view uri) {
    const std::size_t comma = uri.find(',');
    if (!is_data_uri(uri) || comma == std::string_view::npos) return std::nullopt;
    std::string_view head = uri.substr(5, comma - 5);
    constexpr std::string_view kBase64 = ";base64";
    const bool is_base64 = head.size() >= kBase64.size() &&
                           begins_with(head.substr(head.size() - kBase64.size()), kBase64);
    if (is_base64) head.remove_suffix(kBase64.size());
    DataUri result;
    // Parameters of the form name=value follow the media type.
    std::size_t start = head.find(';');
    result.media_type = std::string(head.substr(0, start));
    for (char& c : result.media_type) c = lower(c);
    while (start != std::string_view::npos) {
        const std::size_t end = head.find(';', start + 1);
        const std::string_view parameter = head.substr(start + 1, end - start - 1);
        if (parameter.find('=') == std::string_view::npos) return std::nullopt;
        start = end;
    }
    const std::string_view text = uri.substr(comma + 1);
    std::optional<std::string> bytes;
    if (!is_base64) {
        bytes = percent_decoded(text);
    } else if (text.find('%') == std::string_view::npos) {
        bytes = base64_decoded(text);
    } else if (const auto decoded = percent_decoded(text)) {
        bytes = base64_decoded(*decoded);
    }
    if (!bytes) return std::nullopt;
    result.bytes = std::move(*bytes);
    return result;
}

}  // namespace alhazen::gltf
