#pragma once
/// Parse tree common to both text formats: blocks of named values and lists, without semantics.
///
///     file  := { item }
///     item  := WORD "=" value [";"] | entry [";"] | WORD [";"] | block | ";"
///     entry := WORD (STRING | NUMBER | list | block | STRING block)     also `name WORD`
///     value := NUMBER | STRING | WORD | list | block | WORD (list | block)
///     list  := "(" [ value { "," value } ] ")"                          or with brackets [ ]
///     block := "{" { item } "}"
///
/// Source: the union of the two grammars of the SBT-raytracer format
/// (docs/reference/formats/ray.md).
/// Conventions: parsed with an explicit stack; nesting depth costs no recursion. Nodes lie in one
/// array in text order (24 bytes per node); a subtree is a range. Syntax errors are reported and
/// parsing continues; nodes left incomplete are `broken()` and must not be reported again.

#include <cstdint>
#include <iterator>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "alhazen/formats/text/lexer.h"

namespace alhazen {

enum class NodeKind : std::uint8_t { Block, Pair, Entry, List, Number, Word, String };

class TextNode;

class TextTree {
  public:
    struct Limits {
        int max_nesting = 256;  ///< of lists and blocks; capped at kMaxNesting
        std::uint64_t max_nodes = 400'000'000;
        bool string_escapes = false;  ///< see Lexer
        /// The value of a pair may be `WORD block`; if not, the block is the next item.
        bool pairs_take_blocks = true;
    };
    /// Readers of the tree recurse; this limit bounds their stack, also under sanitizers.
    static constexpr int kMaxNesting = 500;

    /// Parses all of `source`, which must outlive the tree. Throws Error (Resource) beyond
    /// max_nodes.
    TextTree(const SourceText& source, const Limits& limits, Diagnostics& diagnostics);

    /// The items of the file, as a block.
    [[nodiscard]] TextNode root() const;

  private:
    friend class TextNode;
    friend class TextParser;

    struct Node {
        union {
            double number;
            std::uint32_t length;  ///< text length of a word, string, pair or entry
        };
        std::uint32_t offset = 0;
        std::uint32_t end = 0;  ///< one past the last index of the subtree
        NodeKind kind = NodeKind::Block;
        bool broken = false;
    };
    static_assert(sizeof(Node) <= 24);

    const SourceText* source_;
    std::vector<Node> nodes_;
    /// Strings with resolved escapes, by offset.
    std::unordered_map<std::uint32_t, std::string> unescaped_;
};

/// A node of a tree: cheap to copy, valid while the tree exists.
class TextNode {
  public:
    class Iterator {
      public:
        using iterator_category = std::forward_iterator_tag;
        using value_type = TextNode;
        using difference_type = std::ptrdiff_t;
        using pointer = void;
        using reference = TextNode;
        Iterator(const TextTree* tree, std::uint32_t index) : tree_(tree), index_(index) {}
        TextNode operator*() const { return {tree_, index_}; }
        Iterator& operator++() {
            index_ = tree_->nodes_[index_].end;
            return *this;
        }
        friend bool operator==(const Iterator&, const Iterator&) = default;

      private:
        const TextTree* tree_;
        std::uint32_t index_;
    };

    TextNode(const TextTree* tree, std::uint32_t index) : tree_(tree), index_(index) {}

    [[nodiscard]] NodeKind kind() const { return node().kind; }
    [[nodiscard]] bool is(NodeKind k) const { return kind() == k; }
    /// True if the node is an entry or a pair of that name.
    [[nodiscard]] bool is(NodeKind k, std::string_view name) const {
        return kind() == k && text() == name;
    }
    /// The name of a pair or entry, the text of a word or string; otherwise empty.
    [[nodiscard]] std::string_view text() const;
    /// 0 unless the node is a number.
    [[nodiscard]] double number() const { return is(NodeKind::Number) ? node().number : 0.0; }
    /// True if a syntax error inside was reported; the content must not be used.
    [[nodiscard]] bool broken() const { return node().broken; }
    [[nodiscard]] FileLocation location() const { return tree_->source_->location(node().offset); }

    [[nodiscard]] Iterator begin() const { return {tree_, index_ + 1}; }
    [[nodiscard]] Iterator end() const { return {tree_, node().end}; }
    [[nodiscard]] bool empty() const { return index_ + 1 == node().end; }
    /// Number of children, in time linear in it.
    [[nodiscard]] std::size_t size() const;
    /// Precondition: not empty.
    [[nodiscard]] TextNode first() const { return {tree_, index_ + 1}; }

    /// The node for messages: "number", "a list of 3 values", "'translate(...)'".
    [[nodiscard]] std::string describe() const;

  private:
    [[nodiscard]] const TextTree::Node& node() const { return tree_->nodes_[index_]; }

    const TextTree* tree_;
    std::uint32_t index_;
};

inline TextNode TextTree::root() const {
    return {this, 0};
}

}  // namespace alhazen
