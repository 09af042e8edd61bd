#pragma once
/// Splits the text formats into words, strings, numbers and punctuation.
///
/// Source: the token rules shared by the SBT-raytracer format and our own (docs/reference/formats).
/// Differs: numbers are those of C (the old format knew neither `+` nor `E`), and must be read to
/// the end: `1-2` is refused, not taken for 1. Conventions: bytes in, views into them out; columns
/// count bytes from 1. Findings about single tokens go to the diagnostics and lexing goes on, so
/// that a parser need not report them again.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "alhazen/base/diagnostics.h"

namespace alhazen {

/// The bytes of one file and the way from an offset to line and column.
class SourceText {
  public:
    /// `bytes` must outlive the object. Throws Error (Resource) beyond 4 GiB: offsets are 32 bits.
    SourceText(std::string_view bytes, std::string file);

    [[nodiscard]] std::string_view bytes() const { return bytes_; }
    [[nodiscard]] const std::string& file() const { return file_; }
    [[nodiscard]] FileLocation location(std::uint32_t offset) const;

  private:
    std::string_view bytes_;
    std::string file_;
    mutable std::vector<std::uint32_t> line_starts_;  ///< made by the first question
};

enum class TokenKind { Word, String, Number, Punctuation, End };

struct Token {
    TokenKind kind = TokenKind::End;
    std::uint32_t offset = 0;
    std::string_view text;  ///< of a string, without its quotes; escapes as they are written
    double number = 0;      ///< always finite
    bool damaged = false;   ///< already reported; the value is a stand-in

    [[nodiscard]] bool is(char c) const {
        return kind == TokenKind::Punctuation && text.front() == c;
    }
};

/// As in a message: `'{'`, `number 5`, `"a"`, `end of file`.
[[nodiscard]] std::string describe(const Token& token);
/// `text` with unprintable bytes as \xNN, cut to a length that fits a message.
[[nodiscard]] std::string printable(std::string_view text);

/// The bytes that a string with escapes means: \" \\ \n \r \t and \xHH, one byte by its two hex
/// digits. Nothing when there is another escape.
[[nodiscard]] std::optional<std::string> unescaped(std::string_view text);

class Lexer {
  public:
    /// With `string_escapes` a backslash in a string takes the next character with it; the old
    /// formats have none.
    Lexer(const SourceText& source, Diagnostics& diagnostics, bool string_escapes = false)
        : source_(source),
          text_(source.bytes()),
          diagnostics_(diagnostics),
          string_escapes_(string_escapes) {}

    /// The next token; End for ever after the last one.
    [[nodiscard]] Token next();

  private:
    void skip_blanks_and_comments();
    void skip_block_comment();
    Token word();
    Token string();
    Token number();
    void skip_rubbish();
    void error(std::size_t offset, std::string message);

    const SourceText& source_;
    std::string_view text_;
    Diagnostics& diagnostics_;
    bool string_escapes_;
    std::size_t at_ = 0;
};

}  // namespace alhazen
