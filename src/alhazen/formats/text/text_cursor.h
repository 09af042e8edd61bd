#pragma once
/// Forward cursor over a text, word by word, with line and column.
///
/// For formats with large files (NFF, PLY, OBJ): copies nothing; reads numbers with
/// std::from_chars, independent of the locale.
///
/// Source: Clinger, "How to Read Floating Point Numbers Accurately", 1990, for short decimals: the
/// quotient of two exact doubles is the correctly rounded number.
/// Conventions: a number may start with `+` and ends where `at_word_end` says.
/// Lines end at \n, \r\n or \r. Lines and columns count from 1. NaN and infinities are not numbers.

#include <charconv>
#include <climits>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>

#include "alhazen/base/error.h"
#include "alhazen/base/interruption.h"

namespace alhazen {

class TextCursor {
  public:
    explicit TextCursor(std::string_view text, std::int64_t first_line = 1)
        : next_(text.data()),
          line_start_(text.data()),
          end_(text.data() + text.size()),
          line_(first_line) {}

    [[nodiscard]] bool at_end() const { return next_ == end_; }
    /// The next character; NUL at the end of the text.
    [[nodiscard]] char peek() const { return next_ == end_ ? '\0' : *next_; }
    [[nodiscard]] std::size_t bytes_left() const { return std::size_t(end_ - next_); }

    /// Location of the next character.
    [[nodiscard]] FileLocation location(const std::string& file) const {
        const auto clamped = [](std::int64_t n) { return n > INT_MAX ? INT_MAX : int(n); };
        return {file, clamped(line_), clamped(next_ - line_start_ + 1)};
    }
    [[nodiscard]] std::int64_t line() const { return line_; }

    /// Moves to the next nonblank character of this line; false at the end of the line. A backslash
    /// that only blanks separate from the end of the line continues it.
    bool skip_blanks() {
        for (;;) {
            while (next_ != end_ && is_blank(*next_)) ++next_;
            if (next_ == end_ || is_newline(*next_)) return false;
            if (*next_ != '\\' || !joins_lines()) return true;
        }
    }
    /// True at white space, at a backslash that continues the line, and at the end of the text.
    [[nodiscard]] bool at_word_end() const { return ends_word(next_); }
    /// True if only blanks precede the next character in its line.
    [[nodiscard]] bool begins_line() const {
        const char* at = next_;
        while (at != line_start_ && is_blank(at[-1])) --at;
        return at == line_start_;
    }
    /// Moves past the end of this line.
    void skip_line() {
        while (next_ != end_ && !is_newline(*next_)) ++next_;
        step_over_newline();
    }
    /// Returns the characters up to the end of this line; the cursor stops at the line end.
    std::string_view rest_of_line() {
        const char* const begin = next_;
        while (next_ != end_ && !is_newline(*next_)) ++next_;
        return {begin, std::size_t(next_ - begin)};
    }
    /// Moves to the next word, across lines and comments (from one of `comment_marks` to the end of
    /// the line); false at the end of the text.
    bool skip_to_word(std::string_view comment_marks = {}) {
        interruption_point();
        while (next_ != end_) {
            if (is_newline(*next_)) {
                step_over_newline();
            } else if (is_blank(*next_)) {
                ++next_;
            } else if (comment_marks.find(*next_) != std::string_view::npos) {
                skip_line();
            } else {
                return true;
            }
        }
        return false;
    }

    /// Returns the next `count` characters without a line end; the cursor moves past them.
    /// Precondition: there are as many.
    std::string_view characters(std::size_t count) {
        next_ += count;
        return {next_ - count, count};
    }
    /// Reads the characters up to the next white space.
    std::string_view word() {
        const char* const begin = next_;
        while (next_ != end_ && !is_space(*next_)) ++next_;
        return {begin, std::size_t(next_ - begin)};
    }
    /// The next word, at most 40 characters, for messages; the cursor does not move.
    [[nodiscard]] std::string shown_word() const {
        TextCursor copy = *this;
        const std::string_view text = copy.word();
        if (text.empty()) return "the end of the line";
        std::string shown = "'";
        for (const char c : text.substr(0, 40)) {
            shown += static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? '?' : c;
        }
        return shown + (text.size() > 40 ? "...'" : "'");
    }

    /// Reads a finite number. On failure the cursor does not move.
    bool number(double& value) {
        if (short_decimal(value)) return true;
        const char* const begin = next_ != end_ && *next_ == '+' ? next_ + 1 : next_;
        if (begin != next_ && begin != end_ && *begin == '-') return false;
        const auto [stop, error] = std::from_chars(begin, end_, value);
        if (error == std::errc::result_out_of_range) {
            // Underflow reads as zero; overflow is an error.
            if (!underflows({begin, std::size_t(stop - begin)})) return false;
            value = 0.0;
        } else if (error != std::errc{} || !std::isfinite(value)) {
            return false;
        }
        if (!ends_word(stop)) return false;
        next_ = stop;
        return true;
    }
    /// Reads an integer that ends as a number. On failure the cursor does not move.
    bool integer(std::int64_t& value) {
        const char* const start = next_;
        if (!leading_integer(value)) return false;
        if (at_word_end()) return true;
        next_ = start;
        return false;
    }
    /// Reads an integer regardless of the character after it.
    bool leading_integer(std::int64_t& value) {
        if (short_integer(value)) return true;
        const char* const begin = next_ != end_ && *next_ == '+' ? next_ + 1 : next_;
        if (begin != next_ && begin != end_ && *begin == '-') return false;
        const auto [stop, error] = std::from_chars(begin, end_, value);
        if (error != std::errc{}) return false;
        next_ = stop;
        return true;
    }
    /// Skips the next character if it is `c`. Precondition: `c` is not a line end.
    bool take(char c) {
        if (next_ == end_ || *next_ != c) return false;
        ++next_;
        return true;
    }

    [[nodiscard]] static bool is_newline(char c) { return c == '\n' || c == '\r'; }
    [[nodiscard]] static bool is_blank(char c) {
        return c == ' ' || c == '\t' || c == '\v' || c == '\f';
    }
    [[nodiscard]] static bool is_space(char c) { return is_blank(c) || is_newline(c); }

  private:
    [[nodiscard]] static bool is_digit(char c) { return c >= '0' && c <= '9'; }
    /// Moves `at` past digits and appends them to `value`, which wraps around after nineteen.
    void take_digits(const char*& at, std::uint64_t& value) const {
        for (; at != end_ && is_digit(*at); ++at) value = 10 * value + std::uint64_t(*at - '0');
    }
    /// Reads a number without sign of at most eighteen digits; false, not moved, at any other.
    bool short_integer(std::int64_t& value) {
        const char* at = next_;
        std::uint64_t digits = 0;
        take_digits(at, digits);
        if (at == next_ || at - next_ > 18) return false;
        value = std::int64_t(digits);
        next_ = at;
        return true;
    }
    /// Reads a number as 12 or -0.125, of at most fifteen digits; false, not moved, at any other.
    bool short_decimal(double& value) {
        static constexpr double kPowers[] = {1e0, 1e1, 1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                             1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15};
        const bool negative = next_ != end_ && *next_ == '-';
        const char* const begin = next_ + negative;
        const char* at = begin;
        std::uint64_t digits = 0;
        take_digits(at, digits);
        std::ptrdiff_t count = at - begin, decimals = 0;
        if (count == 0) return false;
        if (at != end_ && *at == '.') {
            const char* const point = at++;
            take_digits(at, digits);
            decimals = at - point - 1;
            if (decimals == 0) return false;
            count += decimals;
        }
        if (count > 15 || !ends_word(at)) return false;
        const double size = double(std::int64_t(digits)) / kPowers[decimals];
        value = negative ? -size : size;
        next_ = at;
        return true;
    }
    void step_over_newline() {
        if (next_ == end_) return;
        if (*next_ == '\r' && next_ + 1 != end_ && next_[1] == '\n') ++next_;
        ++next_;
        ++line_;
        line_start_ = next_;
    }
    [[nodiscard]] bool ends_word(const char* at) const {
        return at == end_ || is_space(*at) || (*at == '\\' && line_end_behind(at) != nullptr);
    }
    /// The end of the line, or of the text, if only blanks separate it from the character; else
    /// null.
    [[nodiscard, gnu::noinline, gnu::cold]] const char* line_end_behind(const char* at) const {
        const char* after = at + 1;
        while (after != end_ && is_blank(*after)) ++after;
        return after != end_ && !is_newline(*after) ? nullptr : after;
    }
    bool joins_lines() {
        const char* const after = line_end_behind(next_);
        if (after == nullptr) return false;
        next_ = after;
        step_over_newline();
        return true;
    }
    /// True if a number outside the range of double is too small.
    static bool underflows(std::string_view number) {
        const std::size_t exponent = number.find_first_of("eE");
        if (exponent != std::string_view::npos && exponent + 1 < number.size()) {
            return number[exponent + 1] == '-';
        }
        const std::size_t digit = number.find_first_of("123456789.");
        return digit != std::string_view::npos && number[digit] == '.';
    }

    const char* next_;
    const char* line_start_;
    const char* end_;
    std::int64_t line_;
};

}  // namespace alhazen
