#pragma once
/// The words of Tcl text: commands, and lists within braces. Nothing is evaluated.
///
/// Source: Ousterhout, "Tcl: An Embeddable Command Language", USENIX Winter 1990; the rules of
/// Tcl's manual page `Tcl(n)`. Differs: variables and commands in brackets are refused, because
/// data has none. Conventions: words point into the text, so that each has its place in it.
/// Complexity: O(length); lists in lists are read as a stream of tokens and need no recursion.

#include <string>
#include <string_view>
#include <vector>

#include "alhazen/base/diagnostics.h"
#include "alhazen/formats/brlcad/brlcad_tree.h"

namespace alhazen {

/// Lines and columns of places in a text; fast where places are asked for in their order.
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
    std::string_view text;  ///< without the braces or quotes around it
    bool braced = false;
};

/// The word with its backslashes resolved.
[[nodiscard]] std::string tcl_value(const TclWord& word);

/// Splits a text into commands.
class TclCommands {
  public:
    explicit TclCommands(std::string_view text) : text_(text) {}
    /// The words of the next command that is not empty; false at the end. Throws Error (Scene) with
    /// no location for what is no Tcl; `at()` tells where. Reading may go on with the next line.
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
