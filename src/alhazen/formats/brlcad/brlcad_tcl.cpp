#include "alhazen/formats/brlcad/brlcad_tcl.h"

#include <algorithm>
#include <climits>

#include "alhazen/formats/text/text_cursor.h"

namespace alhazen {

namespace {

bool is_brace(char c) {
    return c == '{' || c == '}';
}

[[noreturn]] void refuse(const std::string& message) {
    throw Error(ErrorKind::Scene, message);
}

}  // namespace

BrlcadPlace TextPlaces::of(const char* at) {
    const auto target = std::min(static_cast<std::size_t>(at - text_.data()), text_.size());
    if (target < seen_) {
        seen_ = line_start_ = 0;
        line_ = 1;
    }
    for (; seen_ < target; ++seen_) {
        if (text_[seen_] != '\n') continue;
        line_start_ = seen_ + 1;
        if (line_ < INT_MAX) ++line_;
    }
    const std::size_t column = target - line_start_ + 1;
    return {line_, static_cast<int>(std::min<std::size_t>(column, INT_MAX))};
}

std::string tcl_value(const TclWord& word) {
    if (word.braced || word.text.find('\\') == std::string_view::npos) {
        return std::string(word.text);
    }
    std::string value;
    for (std::size_t i = 0; i < word.text.size(); ++i) {
        char c = word.text[i];
        if (c == '\\' && i + 1 < word.text.size()) {
            c = word.text[++i];
            c = c == 'n' ? '\n' : c == 't' ? '\t' : c;
        }
        value += c;
    }
    return value;
}

void TclCommands::skip_line() {
    while (position_ < text_.size() && text_[position_] != '\n') ++position_;
}

bool TclCommands::skip_to_command() {
    while (position_ < text_.size()) {
        const char c = text_[position_];
        if (c == '#') {
            skip_line();
        } else if (TextCursor::is_space(c) || c == ';') {
            ++position_;
        } else {
            return true;
        }
    }
    return false;
}

/// Skips blanks within a command; false at its end.
bool TclCommands::skip_to_word() {
    while (position_ < text_.size()) {
        const char c = text_[position_];
        if (TextCursor::is_blank(c)) {
            ++position_;
        } else if (c == '\\' && position_ + 1 < text_.size() &&
                   TextCursor::is_newline(text_[position_ + 1])) {
            position_ += text_.substr(position_ + 1).starts_with("\r\n") ? 3 : 2;
        } else {
            return !TextCursor::is_newline(c) && c != ';';
        }
    }
    return false;
}

TclWord TclCommands::braced_word() {
    const std::size_t open = position_;
    std::size_t depth = 0;
    for (; position_ < text_.size(); ++position_) {
        const char c = text_[position_];
        if (c == '\\') {
            ++position_;
        } else if (c == '{') {
            ++depth;
        } else if (c == '}' && --depth == 0) {
            ++position_;
            return {text_.substr(open + 1, position_ - open - 2), true};
        }
    }
    position_ = open;
    refuse("this brace is never closed");
}

TclWord TclCommands::quoted_word() {
    const std::size_t open = position_++;
    for (; position_ < text_.size(); ++position_) {
        const char c = text_[position_];
        if (c == '\\') {
            ++position_;
        } else if (c == '"') {
            ++position_;
            return {text_.substr(open + 1, position_ - open - 2), false};
        }
    }
    position_ = open;
    refuse("this quotation mark is never closed");
}

TclWord TclCommands::bare_word() {
    const std::size_t begin = position_;
    for (; position_ < text_.size(); ++position_) {
        const char c = text_[position_];
        if (TextCursor::is_space(c) || c == ';') break;
        if (c == '$' || c == '[') {
            refuse(std::string("'") + c + "': variables and commands within words are not read");
        }
        if (c == '\\') ++position_;
    }
    position_ = std::min(position_, text_.size());
    return {text_.substr(begin, position_ - begin), false};
}

TclWord TclCommands::word() {
    const char c = text_[position_];
    if (c != '{' && c != '"') return bare_word();
    const TclWord word = c == '{' ? braced_word() : quoted_word();
    if (position_ < text_.size() && !TextCursor::is_space(text_[position_]) &&
        text_[position_] != ';') {
        refuse("expected a blank after the closing brace or quotation mark");
    }
    return word;
}

bool TclCommands::next(std::vector<TclWord>& words) {
    words.clear();
    if (!skip_to_command()) return false;
    do {
        words.push_back(word());
    } while (skip_to_word());
    return true;
}

TclToken TclTokens::next() {
    while (position_ < list_.size() && TextCursor::is_space(list_[position_])) ++position_;
    TclToken token;
    token.at = list_.data() + position_;
    if (position_ == list_.size()) return token;
    const char c = list_[position_];
    if (is_brace(c)) {
        ++position_;
        token.kind = c == '{' ? TclTokenKind::Open : TclTokenKind::Close;
        return token;
    }
    const std::size_t begin = position_;
    while (position_ < list_.size() && !TextCursor::is_space(list_[position_]) &&
           !is_brace(list_[position_])) {
        position_ += list_[position_] == '\\' ? 2 : 1;
    }
    position_ = std::min(position_, list_.size());
    token.kind = TclTokenKind::Word;
    token.word.text = list_.substr(begin, position_ - begin);
    return token;
}

}  // namespace alhazen
