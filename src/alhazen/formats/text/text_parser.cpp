#include "alhazen/formats/text/text_parser.h"

#include <optional>
#include <utility>

namespace alhazen {

Token TextParser::take() {
    const Token taken = token_;
    token_ = ahead_;
    ahead_ = lexer_.next();
    return taken;
}

std::uint32_t TextParser::add(NodeKind kind, const Token& token) {
    if (nodes_.size() >= max_nodes_) {
        throw Error(ErrorKind::Resource,
                    "more than " + std::to_string(max_nodes_) + " values in one file",
                    source_.location(token.offset));
    }
    TextTree::Node node;
    node.offset = token.offset;
    node.kind = kind;
    node.broken = token.damaged;
    if (kind == NodeKind::Number) {
        node.number = token.number;
    } else {
        // The offset of a string is that of its opening quote, for messages; its text starts one
        // later.
        node.length = static_cast<std::uint32_t>(token.text.size());
    }
    nodes_.push_back(node);
    const auto index = static_cast<std::uint32_t>(nodes_.size() - 1);
    nodes_[index].end = index + 1;
    return index;
}

void TextParser::unescape(Token& token) {
    if (token.damaged || token.text.find('\\') == std::string_view::npos) return;
    if (std::optional<std::string> meant = unescaped(token.text)) {
        unescaped_.emplace(token.offset, std::move(*meant));
        return;
    }
    diagnostics_.error(source_.location(token.offset),
                       "a string may escape \\\" \\\\ \\n \\r \\t and \\xHH, nothing else");
    token.damaged = true;
}

void TextParser::add_leaf(NodeKind kind) {
    Token token = take();
    if (string_escapes_ && kind == NodeKind::String) unescape(token);
    add(kind, token);
    if (token.damaged) mark_broken();
    value_done();
}

void TextParser::open(NodeKind kind, char closer) {
    const std::uint32_t node = add(kind, take());
    stack_.push_back({.node = node, .kind = kind, .closer = closer});
}

void TextParser::open_bracket() {
    if (nesting_ >= max_nesting_) {
        diagnostics_.error(
            source_.location(token_.offset),
            "nested deeper than " + std::to_string(max_nesting_) + " lists and blocks");
        stopped_ = true;
        return;
    }
    ++nesting_;
    if (token_.is('{')) {
        open(NodeKind::Block, '}');
    } else {
        open(NodeKind::List, token_.is('(') ? ')' : ']');
    }
}

/// Marks the completed value in the enclosing node.
void TextParser::value_done() {
    if (stack_.empty()) return;
    stack_.back().has_value = true;
    stack_.back().wants_separator = true;
    if (stack_.back().kind == NodeKind::Pair) close();
}

void TextParser::close() {
    const Frame frame = stack_.back();
    stack_.pop_back();
    nodes_[frame.node].end = static_cast<std::uint32_t>(nodes_.size());
    const bool bracket = frame.kind == NodeKind::Block || frame.kind == NodeKind::List;
    if (bracket && frame.closer != 0) --nesting_;
    if (stack_.empty()) return;
    // A bracketed argument ends the entry.
    if (bracket && stack_.back().kind == NodeKind::Entry) {
        close();
    } else {
        value_done();
    }
}

void TextParser::close_to(std::size_t depth) {
    while (stack_.size() > depth) close();
}

void TextParser::word_value() {
    const bool takes_blocks = pairs_take_blocks_ || stack_.back().kind != NodeKind::Pair;
    if (ahead_.is('(') || (ahead_.is('{') && takes_blocks)) {
        open(NodeKind::Entry);
    } else {
        add_leaf(NodeKind::Word);
    }
}

void TextParser::value() {
    switch (token_.kind) {
        case TokenKind::Number:
            return add_leaf(NodeKind::Number);
        case TokenKind::String:
            return add_leaf(NodeKind::String);
        case TokenKind::Word:
            return word_value();
        case TokenKind::End:
            return end_of_file();
        case TokenKind::Punctuation:
            break;
    }
    if (token_.is('(') || token_.is('[') || token_.is('{')) return open_bracket();
    syntax_error("a value");
    if (stack_.back().kind == NodeKind::List) return recover_in_list();
    // A pair without a value ends here.
    close();
    if (token_.is(',') || token_.is('=')) take();
}

void TextParser::list_step() {
    Frame& list = stack_.back();
    if (token_.is(list.closer)) {
        if (!list.wants_separator && list.has_value) syntax_error("a value after ','");
        take();
        return close();
    }
    if (!list.wants_separator) return value();
    if (token_.is(',')) {
        take();
        list.wants_separator = false;
        return;
    }
    if (token_.kind == TokenKind::End) return end_of_file();
    if (token_.is(')') || token_.is(']') || token_.is('}')) return mismatched_closer();
    syntax_error(std::string("',' or '") + list.closer + "'");
    recover_in_list();
}

/// Reads the arguments of an entry: one string or number, then one list or block.
void TextParser::entry_step() {
    Frame& entry = stack_.back();
    const bool first = !entry.has_value;
    if (token_.is('{') || (first && token_.is('('))) return open_bracket();
    if (first && token_.kind == TokenKind::String) return add_leaf(NodeKind::String);
    if (first && token_.kind == TokenKind::Number) {
        add_leaf(NodeKind::Number);
        return close();
    }
    if (first && token_.kind == TokenKind::Word) add_leaf(NodeKind::Word);  // `name WORD`
    close();
}

void TextParser::item() {
    if (token_.is(';')) {
        take();
    } else if (token_.is('}') && stack_.back().closer == '}') {
        take();
        close();
    } else if (token_.is('{')) {
        open_bracket();
    } else if (token_.kind == TokenKind::Word) {
        const bool arguments = ahead_.is('(') || ahead_.is('{') ||
                               ahead_.kind == TokenKind::String || ahead_.kind == TokenKind::Number;
        if (ahead_.is('=')) {
            open(NodeKind::Pair);
            take();
        } else if (arguments || (token_.text == "name" && ahead_.kind == TokenKind::Word)) {
            open(NodeKind::Entry);
        } else {
            add_leaf(NodeKind::Word);
        }
    } else if (token_.kind == TokenKind::End) {
        end_of_file();
    } else if (token_.is(')') || token_.is(']') || token_.is('}')) {
        mismatched_closer();
    } else {
        syntax_error("a name");
        recover_in_block();
    }
}

void TextParser::parse() {
    add(NodeKind::Block, {.kind = TokenKind::Punctuation, .text = "{"});
    stack_.push_back({.node = 0, .kind = NodeKind::Block});
    while (!stopped_) {
        switch (stack_.back().kind) {
            case NodeKind::Block:
                item();
                break;
            case NodeKind::List:
                list_step();
                break;
            case NodeKind::Entry:
                entry_step();
                break;
            default:
                value();
                break;
        }
    }
    if (token_.kind != TokenKind::End) {
        for (std::size_t i = 1; i < stack_.size(); ++i) nodes_[stack_[i].node].broken = true;
    }
    close_to(0);
}

}  // namespace alhazen
