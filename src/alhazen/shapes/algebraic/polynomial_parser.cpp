#include "alhazen/shapes/algebraic/polynomial_parser.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <string>

#include "alhazen/base/error.h"

namespace alhazen {

namespace {

using Node = PolynomialExpression::Node;
using Op = PolynomialExpression::Op;

class Parser {
  public:
    explicit Parser(std::string_view text) : text_(text) {}

    std::vector<Node> parse() {
        const std::uint16_t root = sum(0);
        skip_blanks();
        if (at_ < text_.size()) fail("expected an operator or the end");
        // Drops the nodes of folded constants: only those of the root remain.
        return needed(root);
    }

  private:
    static constexpr int kMaxDepth = 100;
    static constexpr std::size_t kMaxNodes = 2000;

    [[noreturn]] void fail(const std::string& what) const {
        throw Error(ErrorKind::Scene, "column " + std::to_string(at_ + 1) + ": " + what);
    }
    void skip_blanks() {
        while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t')) ++at_;
    }
    bool take(char c) {
        skip_blanks();
        if (at_ >= text_.size() || text_[at_] != c) return false;
        ++at_;
        return true;
    }
    bool take_word(std::string_view word) {
        skip_blanks();
        if (text_.substr(at_, word.size()) != word) return false;
        at_ += word.size();
        return true;
    }

    /// Reuses an equal existing node, such as the square of a coordinate.
    std::uint16_t add(const Node& node) {
        const auto known = std::find_if(nodes_.begin(), nodes_.end(),
                                        [&](const Node& n) { return is_same(n, node); });
        if (known != nodes_.end()) return static_cast<std::uint16_t>(known - nodes_.begin());
        if (nodes_.size() >= kMaxNodes)
            fail("the expression is too long: at most " + std::to_string(kMaxNodes) +
                 " operations");
        nodes_.push_back(node);
        return static_cast<std::uint16_t>(nodes_.size() - 1);
    }
    static bool is_same(const Node& a, const Node& b) {
        const auto bits = [](double x) { return std::bit_cast<std::uint64_t>(x); };
        return a.op == b.op && a.a == b.a && a.b == b.b &&
               bits(a.constant.high) == bits(b.constant.high) &&
               bits(a.constant.low) == bits(b.constant.low);
    }
    std::uint16_t constant(const DoubleDouble& value) {
        if (!std::isfinite(value.high)) fail("a constant is not finite");
        Node node;
        node.constant = value;
        return add(node);
    }
    [[nodiscard]] bool is_constant(std::uint16_t n) const { return nodes_[n].op == Op::Constant; }

    std::uint16_t combine(Op op, std::uint16_t a, std::uint16_t b) {
        if (is_constant(a) && is_constant(b)) {
            const DoubleDouble &u = nodes_[a].constant, &v = nodes_[b].constant;
            return constant(op == Op::Add ? u + v : op == Op::Subtract ? u - v : u * v);
        }
        Node node;
        node.op = op;
        node.a = a;
        node.b = b;
        node.degree = op == Op::Multiply ? nodes_[a].degree + nodes_[b].degree
                                         : std::max(nodes_[a].degree, nodes_[b].degree);
        if (node.degree > PolynomialExpression::kMaxDegree) {
            fail("the degree exceeds " + std::to_string(PolynomialExpression::kMaxDegree));
        }
        return add(node);
    }

    std::uint16_t sum(int depth) {
        if (depth > kMaxDepth) fail("parentheses are nested too deeply");
        std::uint16_t left = product(depth);
        for (;;) {
            if (take('+')) {
                left = combine(Op::Add, left, product(depth));
            } else if (take('-')) {
                left = combine(Op::Subtract, left, product(depth));
            } else {
                return left;
            }
        }
    }

    std::uint16_t product(int depth) {
        std::uint16_t left = factor(depth);
        for (;;) {
            if (take('*')) {
                left = combine(Op::Multiply, left, factor(depth));
            } else if (take('/')) {
                const std::uint16_t by = factor(depth);
                if (!is_constant(by)) fail("expected a constant to divide by");
                if (nodes_[by].constant.high == 0.0) fail("division by zero");
                const DoubleDouble inverse = quotient(DoubleDouble(1.0), nodes_[by].constant);
                left = is_constant(left)
                           ? constant(quotient(nodes_[left].constant, nodes_[by].constant))
                           : combine(Op::Multiply, left, constant(inverse));
            } else {
                return left;
            }
        }
    }

    std::uint16_t factor(int depth) {
        if (depth > kMaxDepth) fail("signs are nested too deeply");
        if (take('+')) return factor(depth + 1);
        if (take('-')) return combine(Op::Multiply, constant(-1.0), factor(depth + 1));
        const std::uint16_t base = atom(depth);
        return take('^') ? power(base, exponent()) : base;
    }

    int exponent() {
        skip_blanks();
        int value = -1;
        const char* begin = text_.data() + at_;
        const auto [end, error] = std::from_chars(begin, text_.data() + text_.size(), value);
        if (error != std::errc() || value < 0) fail("expected a whole number as exponent");
        if (value > 1000) fail("the exponent is too large");
        at_ += static_cast<std::size_t>(end - begin);
        if (at_ < text_.size() && text_[at_] == '.') fail("expected a whole number as exponent");
        return value;
    }

    std::uint16_t power(std::uint16_t base, int n) {
        if (n == 0) return constant(1.0);
        if (n == 1) return base;
        const std::uint16_t half = power(base, n / 2);
        const std::uint16_t even = combine(Op::Multiply, half, half);
        return n % 2 == 0 ? even : combine(Op::Multiply, even, base);
    }

    std::uint16_t atom(int depth) {
        skip_blanks();
        if (take('(')) return closing(sum(depth + 1));
        if (take_word("sqrt")) {
            if (!take('(')) fail("expected '(' after sqrt");
            const std::uint16_t of = closing(sum(depth + 1));
            if (!is_constant(of)) fail("sqrt is for constants only");
            if (nodes_[of].constant.high < 0.0) fail("sqrt of a negative number");
            return constant(square_root(nodes_[of].constant));
        }
        Node node;
        node.degree = 1;
        if (take('x')) return node.op = Op::X, add(node);
        if (take('y')) return node.op = Op::Y, add(node);
        if (take('z')) return node.op = Op::Z, add(node);
        return number();
    }

    std::uint16_t closing(std::uint16_t inner) {
        if (!take(')')) fail("expected ')'");
        return inner;
    }

    std::uint16_t number() {
        if (at_ >= text_.size()) fail("expected a number, x, y, z, sqrt or '(', found the end");
        double value = 0.0;
        const char* begin = text_.data() + at_;
        const auto [end, error] = std::from_chars(begin, text_.data() + text_.size(), value);
        if (error != std::errc() || !std::isfinite(value) ||
            !((*begin >= '0' && *begin <= '9') || *begin == '.')) {
            fail("expected a number, x, y, z, sqrt or '('");
        }
        at_ += static_cast<std::size_t>(end - begin);
        return constant(value);
    }

    /// The nodes that `root` needs, in order, with storage for their coefficients.
    std::vector<Node> needed(std::uint16_t root) const {
        std::vector<bool> used(nodes_.size(), false);
        used[root] = true;
        for (std::size_t i = root + 1u; i-- > 0;) {
            if (!used[i] || nodes_[i].op < Op::Add) continue;
            used[nodes_[i].a] = used[nodes_[i].b] = true;
        }
        std::vector<std::uint16_t> place(nodes_.size(), 0);
        std::vector<Node> kept;
        int coefficients = 0;
        for (std::size_t i = 0; i <= root; ++i) {
            if (!used[i]) continue;
            Node node = nodes_[i];
            node.a = place[node.a];
            node.b = place[node.b];
            node.first = static_cast<std::uint16_t>(coefficients);
            coefficients += node.degree + 1;
            place[i] = static_cast<std::uint16_t>(kept.size());
            kept.push_back(node);
        }
        constexpr int kMost = PolynomialExpression::kMaxCoefficients;
        if (coefficients > kMost) {
            throw Error(ErrorKind::Scene,
                        "the expression is too long: its parts along a line have " +
                            std::to_string(coefficients) + " coefficients, at most " +
                            std::to_string(kMost) + " are supported; nested products have fewer");
        }
        return kept;
    }

    std::string_view text_;
    std::size_t at_ = 0;
    std::vector<Node> nodes_;
};

}  // namespace

std::vector<PolynomialExpression::Node> parse_polynomial(std::string_view text) {
    return Parser(text).parse();
}

}  // namespace alhazen
