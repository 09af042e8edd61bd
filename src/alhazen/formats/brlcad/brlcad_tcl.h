#pragma once
/// Tokens of Tcl text: commands, and lists in braces. Nothing is evaluated.
///
/// Source: Ousterhout, "Tcl: An Embeddable Command Language", USENIX Winter 1990; the rules of
/// Tcl's manual page `Tcl(n)`.
/// Differs: variables and commands in brackets are rejected, since data has none.
/// Conventions: words are views into the text, so that each has a position.
/// Complexity: O(length); nested lists are read as a token stream without recursion.

#include <string>
#include <string_view>
#include <vector>

#include "alhazen/base/diagnostics.h"
#include "alhazen/formats/brlcad/brlcad_tree.h"

namespace alhazen {

/// Lines and columns of positions in a text; fast for ascending positions.
class TextPlaces {
  public:
    explicit TextPlaces(std::string_view text) : text_(text) {}
    [[nodiscard]] BrlcadPlace of(const char* at);

  private:
    std::string_view text_;
    std::size_t seen_ = 0, line_start_ = 0;
    int line_ = 1;
};

struct TclWord {
    std::string_view text;  ///< without surrounding braces or quotes
    bool braced = false;
};

/// The word with its backslash escapes resolved.
[[nodiscard]] std::string tcl_value(const TclWord& word);

/// Splits a text into commands.
class TclCommands {
  public:
    explicit TclCommands(std::string_view text) : text_(text) {}
    /// Reads the words of the next non-empty command; false at the end. Throws Error (Scene)
    /// without a location for invalid Tcl; `at()` gives the position. Reading may continue after
    /// skip_line().
    bool next(std::vector<TclWord>& words);
    [[nodiscard]] const char* at() const { return text_.data() + position_; }
    void skip_line();

  private:
    bool skip_to_command();
    bool skip_to_word();
    TclWord word();
    TclWord braced_word();
    TclWord quoted_word();
    TclWord bare_word();

    std::string_view text_;
    std::size_t position_ = 0;
};

enum class TclTokenKind { Open, Close, Word, End };
struct TclToken {
    TclTokenKind kind = TclTokenKind::End;
    TclWord word;
    const char* at = nullptr;
};

/// A list as a stream of braces and words.
class TclTokens {
  public:
    explicit TclTokens(std::string_view list) : list_(list) {}
    TclToken next();

  private:
    std::string_view list_;
    std::size_t position_ = 0;
};

}  // namespace alhazen
