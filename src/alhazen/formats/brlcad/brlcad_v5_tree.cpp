#include <cmath>

#include "alhazen/formats/brlcad/brlcad_v5_reader.h"
#include "alhazen/formats/text/text_cursor.h"

namespace alhazen {

namespace {

/// Reads a tree without recursion: files may have chains of thousands of operators.
class TreeReader {
  public:
    TreeReader(std::string_view text, TextPlaces& places, const std::string& file)
        : tokens_(text), places_(places), file_(file) {}

    BrlcadTree read() {
        TclToken token = tokens_.next();
        // The outer braces are stripped: the first word is an operator.
        if (token.kind != TclTokenKind::End) open(token);
        while (!open_.empty()) {
            token = tokens_.next();
            if (token.kind == TclTokenKind::Open) {
                open(tokens_.next());
            } else if (token.kind == TclTokenKind::Close ||
                       (token.kind == TclTokenKind::End && open_.size() == 1)) {
                close(token);
            } else {
                fail(token, "expected { and an operand, or }");
            }
        }
        if (tokens_.next().kind != TclTokenKind::End) fail(token, "expected the end of the tree");
        return std::move(tree_);
    }

  private:
    struct Operation {
        BrlcadOperator op;
        std::vector<std::uint32_t> operands;
    };

    [[noreturn]] void fail(const TclToken& token, const std::string& message) {
        const BrlcadPlace place = places_.of(token.at);
        throw Error(ErrorKind::Scene, "tree: " + message, {file_, place.line, place.column});
    }

    /// A word, or the content of its own braces.
    std::string name() {
        TclToken token = tokens_.next();
        if (token.kind == TclTokenKind::Word) return tcl_value(token.word);
        if (token.kind != TclTokenKind::Open) fail(token, "expected the name of a member");
        const char* begin = nullptr;
        const char* end = nullptr;
        while ((token = tokens_.next()).kind == TclTokenKind::Word) {
            if (begin == nullptr) begin = token.at;
            end = token.at + token.word.text.size();
        }
        if (token.kind != TclTokenKind::Close || begin == nullptr) {
            fail(token, "expected the name of a member and }");
        }
        return {begin, end};
    }

    double number() {
        const TclToken token = tokens_.next();
        TextCursor cursor(token.word.text);
        double value = 0.0;
        if (token.kind != TclTokenKind::Word || !cursor.number(value)) {
            fail(token, "expected the sixteen numbers of a matrix");
        }
        return value;
    }

    std::array<double, 16> matrix() {
        std::array<double, 16> m{};
        for (double& value : m) value = number();
        const TclToken close = tokens_.next();
        if (close.kind != TclTokenKind::Close) fail(close, "a matrix has sixteen numbers");
        return m;
    }

    void leaf(const TclToken& at) {
        const BrlcadPlace place = places_.of(at.at);
        std::string member = name();
        std::array<double, 16> m{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
        TclToken token = tokens_.next();
        if (token.kind == TclTokenKind::Open) {
            m = matrix();
            token = tokens_.next();
        }
        const bool whole = open_.empty();
        if (token.kind != TclTokenKind::Close && !(whole && token.kind == TclTokenKind::End)) {
            fail(token, "expected } after member '" + member + "'");
        }
        take(tree_.add_leaf(std::move(member), m, place));
    }

    void open(const TclToken& token) {
        const std::string_view op = token.kind == TclTokenKind::Word ? token.word.text : "";
        if (op == "l") return leaf(token);
        if (op == "u") return open_.push_back({BrlcadOperator::Union, {}});
        if (op == "n" || op == "+") return open_.push_back({BrlcadOperator::Intersection, {}});
        if (op == "-") return open_.push_back({BrlcadOperator::Difference, {}});
        if (op == "^") return open_.push_back({BrlcadOperator::ExclusiveOr, {}});
        if (op == "!") fail(token, "the operator ! (not) is not supported");
        fail(token,
             "expected an operator: l (member), u (union), n (intersection), - "
             "(difference) or ^ (exclusive or)");
    }

    void close(const TclToken& token) {
        const Operation done = std::move(open_.back());
        open_.pop_back();
        if (done.operands.size() != 2) {
            fail(token,
                 "an operator has two operands, not " + std::to_string(done.operands.size()));
        }
        take(tree_.combine(done.op, done.operands[0], done.operands[1]));
    }

    void take(std::uint32_t node) {
        if (open_.empty()) {
            tree_.set_root(node);
        } else {
            open_.back().operands.push_back(node);
        }
    }

    TclTokens tokens_;
    TextPlaces& places_;
    const std::string& file_;
    BrlcadTree tree_;
    std::vector<Operation> open_;
};

}  // namespace

BrlcadTree read_brlcad_tree(std::string_view text, TextPlaces& places, const std::string& file) {
    return TreeReader(text, places, file).read();
}

}  // namespace alhazen
