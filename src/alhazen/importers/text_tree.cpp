#include "alhazen/importers/text_tree.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

namespace alhazen {

/// One frame for every node that is still open. A pair closes after one value, an entry after its
/// arguments, lists and blocks at their bracket.
class TextParser {
  public:
    TextParser(TextTree& tree, const TextTree::Limits& limits, Diagnostics& diagnostics)
        : nodes_(tree.nodes_),
          unescaped_(tree.unescaped_),
          source_(*tree.source_),
          diagnostics_(diagnostics),
          string_escapes_(limits.string_escapes),
          lexer_(source_, diagnostics, limits.string_escapes),
          max_nesting_(std::min(limits.max_nesting, TextTree::kMaxNesting)),
          max_nodes_(std::min<std::uint64_t>(limits.max_nodes,
                                             std::numeric_limits<std::uint32_t>::max() - 1)),
          token_(lexer_.next()),
          ahead_(lexer_.next()) {}

    void parse();

  private:
    struct Frame {
        std::uint32_t node;
        NodeKind kind;
        char closer = 0;               ///< of a list or block; 0 for the file itself
        bool has_value = false;        ///< a value has been read
        bool wants_separator = false;  ///< of a list
    };
    static constexpr int kMaxSyntaxErrors = 50;

    void item();
    void list_step();
    void entry_step();
    void value();
    void word_value();

    Token take();
    std::uint32_t add(NodeKind kind, const Token& token);
    void add_leaf(NodeKind kind);
    void unescape(Token& token);
    void open(NodeKind kind, char closer = 0);
    void open_bracket();
    void close();
    void close_to(std::size_t depth);
    void value_done();

    void syntax_error(const std::string& expected);
    void mark_broken();
    void mismatched_closer();
    void recover_in_list();
    void recover_in_block();
    void end_of_file();

    std::vector<TextTree::Node>& nodes_;
    std::unordered_map<std::uint32_t, std::string>& unescaped_;
    const SourceText& source_;
    Diagnostics& diagnostics_;
    bool string_escapes_;
    Lexer lexer_;
    int max_nesting_;
    std::uint64_t max_nodes_;
    Token token_, ahead_;
    std::vector<Frame> stack_;
    int nesting_ = 0;
    int syntax_errors_ = 0;
    bool stopped_ = false;
};

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
        // Offsets point at the quote of a string, for messages; its text begins one later.
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

/// The node that contains what was just completed learns of it.
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
    // A bracket is the last argument of an entry.
    if (bracket && stack_.back().kind == NodeKind::Entry) {
        close();
    } else {
        value_done();
    }
}

void TextParser::close_to(std::size_t depth) {
    while (stack_.size() > depth) close();
}

/// What is open up to the nearest block is incomplete.
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
    // Everything that is open is incomplete, not only up to the nearest block.
    for (std::size_t i = 1; i < stack_.size(); ++i) nodes_[stack_[i].node].broken = true;
    stopped_ = true;
}

/// token_ is a closing bracket, and not that of the innermost open one.
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
    // The blocks in between are incomplete too: their owners must not be read.
    for (std::size_t i = match + 1; i < stack_.size(); ++i) nodes_[stack_[i].node].broken = true;
    while (stack_.size() > match + 1) close();
    take();
    close();
}

/// Skips to the end of the list, or to the end of the item that it is in.
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

/// Skips to something that can begin an item.
void TextParser::recover_in_block() {
    while (token_.kind != TokenKind::End && token_.kind != TokenKind::Word && !token_.is('}') &&
           !token_.is('{') && !token_.is(';')) {
        take();
    }
}

void TextParser::word_value() {
    if (ahead_.is('(') || ahead_.is('{')) {
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
    // A pair without its value ends where it is.
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

/// The arguments of an entry: one string or number, then one list or block.
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

TextTree::TextTree(const SourceText& source, const Limits& limits, Diagnostics& diagnostics)
    : source_(&source) {
    TextParser(*this, limits, diagnostics).parse();
}

std::string_view TextNode::text() const {
    const TextTree::Node& n = node();
    if (n.kind == NodeKind::Number || n.kind == NodeKind::List || n.kind == NodeKind::Block)
        return {};
    if (n.kind == NodeKind::String && !tree_->unescaped_.empty()) {
        const auto meant = tree_->unescaped_.find(n.offset);
        if (meant != tree_->unescaped_.end()) return meant->second;
    }
    const std::size_t quote = n.kind == NodeKind::String ? 1 : 0;
    return tree_->source_->bytes().substr(n.offset + quote, n.length);
}

std::size_t TextNode::size() const {
    return static_cast<std::size_t>(std::distance(begin(), end()));
}

std::string TextNode::describe() const {
    switch (kind()) {
        case NodeKind::Block:
            return "a block { }";
        case NodeKind::List:
            return "a list of " + std::to_string(size()) + (size() == 1 ? " value" : " values");
        case NodeKind::Number:
            return "a number";
        case NodeKind::Word:
            return "'" + printable(text()) + "'";
        case NodeKind::String:
            return "string \"" + printable(text()) + "\"";
        case NodeKind::Pair:
            return "'" + printable(text()) + " = ...'";
        case NodeKind::Entry:
            break;
    }
    if (empty()) return "'" + printable(text()) + "'";
    const bool list = first().is(NodeKind::List);
    return "'" + printable(text()) + (list ? "(...)'" : " {...}'");
}

}  // namespace alhazen
