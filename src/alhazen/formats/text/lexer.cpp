#include "alhazen/formats/text/lexer.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <utility>

#include "alhazen/base/interruption.h"

namespace alhazen {

namespace {

constexpr std::string_view kPunctuation = "(){}[],=;";

bool is_digit(char c) {
    return c >= '0' && c <= '9';
}
bool is_letter(char c) {
    return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '_';
}
bool is_blank(char c) {
    return c == ' ' || (c >= '\t' && c <= '\r');
}
bool starts_number(char c) {
    return is_digit(c) || c == '-' || c == '+' || c == '.';
}
bool continues_word(char c) {
    return is_letter(c) || is_digit(c) || c == '-';
}
bool continues_number(char c) {
    return is_letter(c) || starts_number(c);
}
bool ends_string(char c) {
    return c == '"' || c == '\n' || c == '\r';
}
/// The value of a hexadecimal digit, 0 to 15, or -1.
int hex_digit(char c) {
    if (is_digit(c)) return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return -1;
}
bool starts_token(char c) {
    return is_letter(c) || starts_number(c) || c == '"' || c == '/' ||
           kPunctuation.find(c) != std::string_view::npos;
}

/// Classifies a number outside the range of double by the position of its first nonzero digit: true
/// for too large, false for too small.
bool is_overflow(std::string_view digits) {
    const std::size_t e = digits.find_first_of("eE");
    long long power = 0;
    if (e != std::string_view::npos) {
        const bool negative = digits[e + 1] == '-';
        std::size_t i = e + 1 + (digits[e + 1] == '-' || digits[e + 1] == '+' ? 1 : 0);
        for (; i < digits.size() && power < 1'000'000'000'000; ++i)
            power = power * 10 + (digits[i] - '0');
        if (negative) power = -power;
    }
    const std::string_view mantissa = digits.substr(0, e);
    const std::size_t first = mantissa.find_first_of("123456789");
    if (first == std::string_view::npos) return false;
    const std::size_t point = std::min(mantissa.find('.'), mantissa.size());
    return power + static_cast<long long>(point) - static_cast<long long>(first) > 0;
}

}  // namespace

SourceText::SourceText(std::string_view bytes, std::string file)
    : bytes_(bytes), file_(std::move(file)) {
    if (bytes.size() >= std::numeric_limits<std::uint32_t>::max()) {
        throw Error(ErrorKind::Resource, "a text scene may have at most 4 GiB", {file_, 0, 0});
    }
}

FileLocation SourceText::location(std::uint32_t offset) const {
    if (line_starts_.empty()) {
        line_starts_.push_back(0);
        for (std::size_t i = bytes_.find_first_of("\r\n"); i != std::string_view::npos;
             i = bytes_.find_first_of("\r\n", i + 1)) {
            if (bytes_.substr(i, 2) == "\r\n") ++i;
            line_starts_.push_back(static_cast<std::uint32_t>(i + 1));
        }
    }
    const auto next = std::upper_bound(line_starts_.begin(), line_starts_.end(), offset);
    return {file_, static_cast<int>(next - line_starts_.begin()),
            static_cast<int>(offset - *(next - 1)) + 1};
}

std::string printable(std::string_view text) {
    constexpr std::size_t kLongest = 40;
    constexpr const char* kHex = "0123456789abcdef";
    std::string out;
    for (const char c : text.substr(0, kLongest)) {
        const auto byte = static_cast<unsigned char>(c);
        if (byte >= 0x20 && byte < 0x7F) {
            out += c;
        } else {
            out += std::string("\\x") + kHex[byte >> 4] + kHex[byte & 15];
        }
    }
    if (text.size() > kLongest) out += "...";
    return out;
}

std::optional<std::string> unescaped(std::string_view text) {
    static constexpr std::pair<char, char> kEscapes[] = {
        {'"', '"'}, {'\\', '\\'}, {'n', '\n'}, {'r', '\r'}, {'t', '\t'}};
    std::string out;
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] != '\\') {
            out += text[i];
            continue;
        }
        if (++i == text.size()) return std::nullopt;
        const auto* const simple =
            std::find_if(std::begin(kEscapes), std::end(kEscapes),
                         [&](const auto& escape) { return escape.first == text[i]; });
        if (simple != std::end(kEscapes)) {
            out += simple->second;
            continue;
        }
        if (text[i] != 'x' || i + 2 >= text.size()) return std::nullopt;
        const int high = hex_digit(text[i + 1]), low = hex_digit(text[i + 2]);
        if (high < 0 || low < 0) return std::nullopt;
        out += static_cast<char>(high * 16 + low);
        i += 2;
    }
    return out;
}

std::string describe(const Token& token) {
    switch (token.kind) {
        case TokenKind::End:
            return "the end of the file";
        case TokenKind::String:
            return "string \"" + printable(token.text) + "\"";
        case TokenKind::Number:
            return "number " + printable(token.text);
        case TokenKind::Word:
        case TokenKind::Punctuation:
            break;
    }
    return "'" + printable(token.text) + "'";
}

void Lexer::error(std::size_t offset, std::string message) {
    diagnostics_.error(source_.location(static_cast<std::uint32_t>(offset)), std::move(message));
}

void Lexer::skip_block_comment() {
    const std::size_t end = text_.find("*/", at_ + 2);
    if (end == std::string_view::npos) {
        error(at_, "unterminated comment: '/*' without '*/'");
        at_ = text_.size();
    } else {
        at_ = end + 2;
    }
}

void Lexer::skip_blanks_and_comments() {
    while (at_ < text_.size()) {
        const char c = text_[at_];
        if (is_blank(c)) {
            ++at_;
        } else if (text_.substr(at_, 2) == "//") {
            at_ = std::min(text_.find_first_of("\r\n", at_), text_.size());
        } else if (text_.substr(at_, 2) == "/*") {
            skip_block_comment();
        } else if (c == '/' || !starts_token(c)) {
            skip_rubbish();
        } else {
            return;
        }
    }
}

/// Reports a run of bytes that start no token as a single error.
void Lexer::skip_rubbish() {
    const std::size_t first = at_++;
    while (at_ < text_.size() && !is_blank(text_[at_]) && !starts_token(text_[at_])) ++at_;
    error(first, "unexpected '" + printable(text_.substr(first, at_ - first)) + "'");
}

Token Lexer::word() {
    const std::size_t first = at_;
    while (at_ < text_.size() && continues_word(text_[at_])) ++at_;
    return {.kind = TokenKind::Word,
            .offset = static_cast<std::uint32_t>(first),
            .text = text_.substr(first, at_ - first)};
}

Token Lexer::string() {
    const std::size_t first = at_++;
    std::size_t end = at_;
    while (end < text_.size() && !ends_string(text_[end])) {
        const bool escape = string_escapes_ && text_[end] == '\\' && end + 1 < text_.size() &&
                            text_[end + 1] != '\n' && text_[end + 1] != '\r';
        end += escape ? 2 : 1;
    }
    Token token{.kind = TokenKind::String,
                .offset = static_cast<std::uint32_t>(first),
                .text = text_.substr(at_, end - at_)};
    at_ = end;
    if (end < text_.size() && text_[end] == '"') {
        ++at_;
    } else {
        error(first, "unterminated string: '\"' expected before the end of the line");
        token.damaged = true;
    }
    return token;
}

Token Lexer::number() {
    const std::size_t first = at_;
    while (at_ < text_.size() && continues_number(text_[at_])) ++at_;
    Token token{.kind = TokenKind::Number,
                .offset = static_cast<std::uint32_t>(first),
                .text = text_.substr(first, at_ - first)};
    std::string_view digits = token.text;
    if (digits.front() == '+' && digits.size() > 1 && digits[1] != '-') digits.remove_prefix(1);
    double value = 0;
    const auto [end, status] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (end != digits.data() + digits.size() || status == std::errc::invalid_argument) {
        error(first, "malformed number '" + printable(token.text) + "'");
        token.damaged = true;
    } else if (status == std::errc::result_out_of_range && is_overflow(digits)) {
        error(first, "number " + printable(token.text) + " is too large");
        token.damaged = true;
    } else if (!std::isfinite(value)) {  // from_chars accepts "-inf" and "-nan"
        error(first, "'" + printable(token.text) + "' is not a finite number");
        token.damaged = true;
    } else if (status == std::errc{}) {
        token.number = value;
    }
    return token;
}

Token Lexer::next() {
    interruption_point();
    skip_blanks_and_comments();
    if (at_ >= text_.size()) {
        return {.kind = TokenKind::End, .offset = static_cast<std::uint32_t>(text_.size())};
    }
    const char c = text_[at_];
    if (is_letter(c)) return word();
    if (c == '"') return string();
    if (starts_number(c)) return number();
    Token token{.kind = TokenKind::Punctuation,
                .offset = static_cast<std::uint32_t>(at_),
                .text = text_.substr(at_, 1)};
    ++at_;
    return token;
}

}  // namespace alhazen
