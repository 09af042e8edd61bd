#include "alhazen/accel/wide_bvh/collapse.h"

#include <algorithm>
#include <array>
#include <vector>

#include "alhazen/base/error.h"

namespace alhazen {
namespace {

constexpr std::uint32_t kWidth = kWideNodeWidth;
constexpr float kNever = std::numeric_limits<float>::infinity();

/// The best ways to turn the subtree of a binary node into at most i wide subtrees, i = 1 ... 8.
struct Choice {
    std::array<float, kWidth + 1> cost;  ///< [i]; of at most i subtrees
    std::array<std::uint8_t, kWidth + 1>
        left;                     ///< [i]; how many go to the left child, 0: do as for i - 1
    std::uint8_t inner_left = 0;  ///< as left[8], for a wide node made of this one
    bool as_leaf = false;         ///< the single subtree is a leaf
    std::uint32_t left_choice, right_choice;  ///< of the children
};

class Collapse {
  public:
    Collapse(const BinaryBvh& binary, std::span<const BuildReference> references,
             const LeafKinds& kinds, LeafSink& sink)
        : binary_(binary), references_(references), kinds_(kinds), sink_(sink) {}

    WideBvh run() {
        const std::uint32_t root = choose(0);
        wide_.empty = false;
        wide_.root = emit({0, root}, 1);
        return std::move(wide_);
    }

  private:
    /// A subtree: its binary node and what was chosen for it.
    struct Subtree {
        std::uint32_t node, choice;
    };

    std::uint32_t choose(std::uint32_t index) {
        const BinaryNode& node = binary_.nodes[index];
        const float area = node.box.weight();
        Choice choice{};
        choice.cost.fill(leaf_cost(node, area));
        choice.as_leaf = true;
        if (!node.is_leaf()) {
            choice.left_choice = choose(index + 1);
            choice.right_choice = choose(node.right);
            weigh(choice, area);
        }
        choices_.push_back(choice);
        return static_cast<std::uint32_t>(choices_.size() - 1);
    }

    [[nodiscard]] float leaf_cost(const BinaryNode& node, float area) const {
        if (node.kind == kLeafKinds) return kNever;
        const LeafKind& kind = kinds_[node.kind];
        const std::uint32_t blocks = kind.blocks(node.size());
        if (blocks > NodeRef::kMaxBlocks) return kNever;
        return area * kind.cost * static_cast<float>(blocks);
    }

    void weigh(Choice& choice, float area) const {
        const Choice& l = choices_[choice.left_choice];
        const Choice& r = choices_[choice.right_choice];
        std::array<float, kWidth + 1>
            spread{};  // [j]: exactly these children, at most j subtrees in all
        for (std::uint32_t j = 2; j <= kWidth; ++j) {
            spread[j] = kNever;
            for (std::uint32_t k = 1; k < j; ++k) {
                const float cost = l.cost[k] + r.cost[j - k];
                if (cost < spread[j] || k == 1) {
                    spread[j] = cost;
                    choice.left[j] = static_cast<std::uint8_t>(k);
                }
            }
        }
        const float inner = area + spread[kWidth];
        choice.as_leaf = choice.cost[1] <= inner && choice.cost[1] < kNever;
        choice.cost[1] = std::min(choice.cost[1], inner);
        choice.inner_left = choice.left[kWidth];
        for (std::uint32_t j = 2; j <= kWidth; ++j) {
            choice.cost[j] = std::min(spread[j], choice.cost[j - 1]);
            if (!(spread[j] < choice.cost[j - 1])) choice.left[j] = 0;
        }
    }

    /// Appends the at most `budget` subtrees that were chosen for a subtree.
    void gather(const Subtree& subtree, std::uint32_t budget, std::vector<Subtree>& out) const {
        const Choice& choice = choices_[subtree.choice];
        while (budget > 1 && choice.left[budget] == 0) --budget;
        if (budget == 1) return out.push_back(subtree);
        divide(subtree, choice.left[budget], budget, out);
    }
    void divide(const Subtree& subtree, std::uint32_t left, std::uint32_t budget,
                std::vector<Subtree>& out) const {
        const Choice& choice = choices_[subtree.choice];
        gather({subtree.node + 1, choice.left_choice}, left, out);
        gather({binary_.nodes[subtree.node].right, choice.right_choice}, budget - left, out);
    }

    NodeRef emit(const Subtree& subtree, int depth) {
        const BinaryNode& node = binary_.nodes[subtree.node];
        const Choice& choice = choices_[subtree.choice];
        if (choice.as_leaf) {
            return sink_.add_leaf(node.kind, references_.subspan(node.begin, node.size()));
        }
        if (depth > kMaxWideDepth || wide_.nodes.size() >= NodeRef::kMaxNodes) {
            throw Error(ErrorKind::Resource, "too many primitives for one wide BVH");
        }
        wide_.depth = std::max(wide_.depth, depth);
        std::vector<Subtree> children;
        children.reserve(kWidth);
        divide(subtree, choice.inner_left, kWidth, children);
        const auto index = static_cast<std::uint32_t>(wide_.nodes.size());
        wide_.nodes.emplace_back();
        for (std::size_t i = 0; i < children.size(); ++i) {
            wide_.nodes[index].set_box(i, binary_.nodes[children[i].node].box);
            const NodeRef child = emit(children[i], depth + 1);
            wide_.nodes[index].child[i] = child;
        }
        wide_.nodes[index].set_order();
        return NodeRef::node(index);
    }

    const BinaryBvh& binary_;
    std::span<const BuildReference> references_;
    LeafKinds kinds_;
    LeafSink& sink_;
    std::vector<Choice> choices_;
    WideBvh wide_;
};

}  // namespace

WideBvh collapse(const BinaryBvh& binary, std::span<const BuildReference> references,
                 const LeafKinds& kinds, LeafSink& sink) {
    if (binary.empty) return {};
    return Collapse(binary, references, kinds, sink).run();
}

}  // namespace alhazen
