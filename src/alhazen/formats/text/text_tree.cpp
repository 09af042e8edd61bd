#include "alhazen/formats/text/text_tree.h"

#include "alhazen/formats/text/text_parser.h"

namespace alhazen {

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
    const char* rest = first().is(NodeKind::List)    ? "(...)'"
                       : first().is(NodeKind::Block) ? " {...}'"
                                                     : " ...'";
    return "'" + printable(text()) + rest;
}

}  // namespace alhazen
