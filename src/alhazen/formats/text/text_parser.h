#pragma once
/// The parser that fills a TextTree (text_tree.h). An explicit stack of frames replaces recursion.
/// Grammar: text_parser.cpp; error recovery: text_parser_errors.cpp.

#include <algorithm>
#include <cstdint>
#include <limits>
#include <string>
#include <unordered_map>
#include <vector>

#include "alhazen/formats/text/text_tree.h"

namespace alhazen {

/// Keeps one frame per open node. A pair closes after one value, an entry after its arguments,
/// lists and blocks at their closing bracket.
class TextParser {
  public:
    TextParser(TextTree& tree, const TextTree::Limits& limits, Diagnostics& diagnostics)
        : nodes_(tree.nodes_),
          unescaped_(tree.unescaped_),
          source_(*tree.source_),
          diagnostics_(diagnostics),
          string_escapes_(limits.string_escapes),
          pairs_take_blocks_(limits.pairs_take_blocks),
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
        char closer = 0;               ///< closing bracket of a list or block; 0 for the file
        bool has_value = false;        ///< at least one value read
        bool wants_separator = false;  ///< lists: a comma is due
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
    bool pairs_take_blocks_;
    Lexer lexer_;
    int max_nesting_;
    std::uint64_t max_nodes_;
    Token token_, ahead_;
    std::vector<Frame> stack_;
    int nesting_ = 0;
    int syntax_errors_ = 0;
    bool stopped_ = false;
};

}  // namespace alhazen
