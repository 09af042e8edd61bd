#pragma once
/// Splits the text formats into words, strings, numbers and punctuation.
///
/// Source: the token rules common to the SBT-raytracer format and the native format
/// (docs/reference/formats).
/// Differs: numbers follow C (the old format had neither `+` nor `E`) and must be read completely:
/// `1-2` is an error, not 1.
/// Conventions: tokens are views into the bytes. Lines end at \n, \r\n or \r; columns count bytes
/// from 1. Errors in single
/// tokens go to the diagnostics and lexing continues; the parser need not report them again.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "alhazen/base/diagnostics.h"

namespace alhazen {

/// The bytes of one file, with the mapping from offsets to lines and columns.
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
    mutable std::vector<std::uint32_t> line_starts_;  ///< built on first use
};

enum class TokenKind { Word, String, Number, Punctuation, End };

struct Token {
    TokenKind kind = TokenKind::End;
    std::uint32_t offset = 0;
    std::string_view text;  ///< for strings: without quotes, escapes not resolved
    double number = 0;      ///< always finite
    bool damaged = false;   ///< already reported; the value is a placeholder

    [[nodiscard]] bool is(char c) const {
        return kind == TokenKind::Punctuation && text.front() == c;
    }
};

/// A token for messages: `'{'`, `number 5`, `"a"`, `end of file`.
[[nodiscard]] std::string describe(const Token& token);
/// `text` with unprintable bytes as \xNN, truncated for messages.
[[nodiscard]] std::string printable(std::string_view text);

/// Resolves the escapes of a string: \" \\ \n \r \t and \xHH (one byte, two hex digits). None for
/// any other escape.
[[nodiscard]] std::optional<std::string> unescaped(std::string_view text);

class Lexer {
  public:
    /// With `string_escapes`, a backslash in a string escapes the next character. The old formats
    /// have no escapes.
    Lexer(const SourceText& source, Diagnostics& diagnostics, bool string_escapes = false)
        : source_(source),
          text_(source.bytes()),
          diagnostics_(diagnostics),
          string_escapes_(string_escapes) {}

    /// The next token; End at the end of the text, repeatedly.
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
