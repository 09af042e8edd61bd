/// Syntax errors: messages, marking of broken nodes, recovery.

#include "alhazen/formats/text/text_parser.h"

namespace alhazen {

/// Marks the open nodes up to the innermost block as broken.
void TextParser::mark_broken() {
    for (std::size_t i = stack_.size(); i-- > 0 && stack_[i].kind != NodeKind::Block;) {
        nodes_[stack_[i].node].broken = true;
    }
}

void TextParser::syntax_error(const std::string& expected) {
    diagnostics_.error(source_.location(token_.offset),
                       "expected " + expected + ", found " + describe(token_));
    mark_broken();
    if (++syntax_errors_ >= kMaxSyntaxErrors) {
        diagnostics_.error(source_.location(token_.offset), "too many syntax errors, giving up");
        stopped_ = true;
    }
}

void TextParser::end_of_file() {
    for (std::size_t i = stack_.size(); i-- > 1;) {
        if (stack_[i].closer == 0) continue;
        const FileLocation opened = source_.location(nodes_[stack_[i].node].offset);
        syntax_error(std::string("'") + stack_[i].closer + "' for the bracket opened in line " +
                     std::to_string(opened.line) + ", column " + std::to_string(opened.column));
        break;
    }
    // All open nodes are incomplete, not only those up to the innermost block.
    for (std::size_t i = 1; i < stack_.size(); ++i) nodes_[stack_[i].node].broken = true;
    stopped_ = true;
}

/// Handles a closing bracket in token_ that does not match the innermost open bracket.
void TextParser::mismatched_closer() {
    std::size_t match = stack_.size();
    while (match-- > 1 && !token_.is(stack_[match].closer)) {
    }
    if (match == 0) {
        const Frame& inner = stack_.back();
        const bool list = inner.kind == NodeKind::List;
        syntax_error(list ? std::string("',' or '") + inner.closer + "'" : "a name");
        const bool other_list_closer = list && !token_.is('}');  // ']' for ')'
        take();
        if (other_list_closer) close();
        return;
    }
    std::size_t inner = stack_.size() - 1;
    while (stack_[inner].closer == 0) --inner;
    const FileLocation opened = source_.location(nodes_[stack_[inner].node].offset);
    syntax_error(std::string("'") + stack_[inner].closer + "' for the bracket opened in line " +
                 std::to_string(opened.line) + ", column " + std::to_string(opened.column));
    // The blocks in between are incomplete too; their owners must not be read.
    for (std::size_t i = match + 1; i < stack_.size(); ++i) nodes_[stack_[i].node].broken = true;
    while (stack_.size() > match + 1) close();
    take();
    close();
}

/// Skips to the end of the list or of the item that contains it.
void TextParser::recover_in_list() {
    int depth = 0;
    while (!stopped_ && token_.kind != TokenKind::End) {
        const bool opens = token_.is('(') || token_.is('[') || token_.is('{');
        const bool closes = token_.is(')') || token_.is(']') || token_.is('}');
        if (depth == 0 && closes && !token_.is('}')) {
            take();
            close();
            return;
        }
        if (depth == 0 && (closes || token_.is(';'))) break;
        depth += opens ? 1 : closes ? -1 : 0;
        take();
    }
    std::size_t block = stack_.size() - 1;
    while (stack_[block].kind != NodeKind::Block) --block;
    close_to(block + 1);
}

/// Skips to the next token that can begin an item.
void TextParser::recover_in_block() {
    while (token_.kind != TokenKind::End && token_.kind != TokenKind::Word && !token_.is('}') &&
           !token_.is('{') && !token_.is(';')) {
        take();
    }
}

}  // namespace alhazen
