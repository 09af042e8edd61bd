#include "alhazen/accel/wide_bvh/collapse.h"

#include <algorithm>
#include <array>
#include <vector>

#include "alhazen/base/error.h"
#include "alhazen/parallel/parallel.h"

namespace alhazen {
namespace {

constexpr std::uint32_t kWidth = kWideNodeWidth;
constexpr float kNever = std::numeric_limits<float>::infinity();
/// Subtrees of so many references are tasks of their own.
constexpr std::uint32_t kTaskSize = 4096;

/// The best ways to turn the subtree of a binary node into at most i wide subtrees.
struct Choice {
    std::array<float, kWidth + 1> cost;  ///< [i]; of at most i subtrees
    std::array<std::uint8_t, kWidth + 1>
        left;                 ///< [i]; how many go to the left child, 0: do as for i - 1
    std::uint8_t inner_left;  ///< as left[kWidth], for a wide node made of this one
    bool as_leaf;             ///< the single subtree is a leaf
};

/// What a wide subtree takes up, or where it begins.
struct Extent {
    std::size_t nodes = 0;
    std::array<std::size_t, kLeafKinds> blocks{};

    void add(const Extent& other) {
        nodes += other.nodes;
        for (std::size_t k = 0; k < kLeafKinds; ++k) blocks[k] += other.blocks[k];
    }
};

/// What was found out about a wide subtree.
struct Plan {
    Extent extent;
    int depth = 0;               ///< levels of inner nodes
    std::vector<Plan> children;  ///< only where they are tasks of their own

    void add(const Plan& child) {
        extent.add(child.extent);
        depth = std::max(depth, child.depth);
    }
};

/// The binary nodes that become the children of a wide node.
struct Children {
    std::array<std::uint32_t, kWidth> node;
    std::uint32_t count = 0;
};

/// Three passes: what to do with each binary node, from the leaves up; what each wide subtree takes
/// up; and then all of them are written, each to its place.
class Collapse {
  public:
    Collapse(const BinaryBvh& binary, std::span<const BuildReference> references,
             const LeafKinds& kinds, LeafSink& sink)
        : binary_(binary),
          references_(references),
          kinds_(kinds),
          sink_(sink),
          choices_(std::make_unique_for_overwrite<Choice[]>(binary.index_count)) {}

    WideBvh run() {
        choose(0);
        const Plan all = plan(0, 1);
        const auto& blocks = all.extent.blocks;
        if (all.depth > kMaxWideDepth || all.extent.nodes >= NodeRef::kMaxNodes ||
            *std::max_element(blocks.begin(), blocks.end()) > NodeRef::kMaxOffset) {
            throw Error(ErrorKind::Resource, "too many primitives for one wide BVH");
        }
        wide_.empty = false;
        wide_.depth = all.depth;
        wide_.nodes.resize(all.extent.nodes);
        sink_.resize(blocks);
        wide_.root = emit(0, all, {});
        return std::move(wide_);
    }

  private:
    [[nodiscard]] static bool is_task(const BinaryNode& node) { return node.size() >= kTaskSize; }

    void choose(std::uint32_t index) {
        const BinaryNode& node = binary_.nodes[index];
        Choice& choice = choices_[index];
        const float area = node.box.weight();
        choice.cost.fill(leaf_cost(node, area));
        choice.left.fill(0);
        choice.as_leaf = true;
        if (node.is_leaf()) return;
        const auto left = [&] { choose(index + 1); };
        const auto right = [&] { choose(node.right); };
        if (is_task(node)) {
            parallel_invoke(left, right);
        } else {
            left();
            right();
        }
        weigh(choice, choices_[index + 1], choices_[node.right], area);
    }

    [[nodiscard]] float leaf_cost(const BinaryNode& node, float area) const {
        if (node.kind == kLeafKinds) return kNever;
        const LeafKind& kind = kinds_[node.kind];
        const std::uint32_t blocks = kind.blocks(node.size());
        if (blocks > NodeRef::kMaxBlocks) return kNever;
        return area * kind.cost * static_cast<float>(blocks);
    }

    static void weigh(Choice& choice, const Choice& l, const Choice& r, float area) {
        std::array<float, kWidth + 1>
            spread{};  // [j]: exactly these children, at most j subtrees in all
        for (std::uint32_t j = 2; j <= kWidth; ++j) {
            float least = kNever;
            std::uint32_t at = 1;
            for (std::uint32_t k = 1; k < j; ++k) {
                const float cost = l.cost[k] + r.cost[j - k];
                at = cost < least ? k : at;
                least = cost < least ? cost : least;
            }
            spread[j] = least;
            choice.left[j] = static_cast<std::uint8_t>(at);
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
    void gather(std::uint32_t index, std::uint32_t budget, Children& out) const {
        const Choice& choice = choices_[index];
        while (budget > 1 && choice.left[budget] == 0) --budget;
        if (budget == 1) {
            out.node[out.count++] = index;
        } else {
            divide(index, choice.left[budget], budget, out);
        }
    }
    void divide(std::uint32_t index, std::uint32_t left, std::uint32_t budget,
                Children& out) const {
        gather(index + 1, left, out);
        gather(binary_.nodes[index].right, budget - left, out);
    }
    [[nodiscard]] Children children(std::uint32_t index) const {
        Children out;
        divide(index, choices_[index].inner_left, kWidth, out);
        return out;
    }

    [[nodiscard]] std::uint32_t blocks_of(const BinaryNode& node) const {
        return kinds_[node.kind].blocks(node.size());
    }

    [[nodiscard]] Plan plan(std::uint32_t index, int depth) const {
        const BinaryNode& node = binary_.nodes[index];
        Plan sum;
        if (choices_[index].as_leaf) {
            sum.extent.blocks[node.kind] = blocks_of(node);
            return sum;
        }
        sum.extent.nodes = 1;
        sum.depth = depth;
        // A tree too deep is refused; what it takes up is not of interest.
        if (depth > kMaxWideDepth) return sum;
        const Children all = children(index);
        if (!is_task(node)) {
            for (std::uint32_t i = 0; i < all.count; ++i) sum.add(plan(all.node[i], depth + 1));
            return sum;
        }
        sum.children.resize(all.count);
        parallel_for(all.count, 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                sum.children[i] = plan(all.node[i], depth + 1);
            }
        });
        for (const Plan& child : sum.children) sum.add(child);
        return sum;
    }

    /// Writes a subtree from `place` on, and moves that behind it.
    NodeRef emit(std::uint32_t index, Extent& place) {
        const BinaryNode& node = binary_.nodes[index];
        if (choices_[index].as_leaf) return emit_leaf(node, place);
        const std::size_t number = place.nodes++;
        const Children all = children(index);
        for (std::uint32_t i = 0; i < all.count; ++i) {
            set_child(number, i, all.node[i], emit(all.node[i], place));
        }
        wide_.nodes[number].set_order();
        return NodeRef::node(static_cast<std::uint32_t>(number));
    }
    NodeRef emit_leaf(const BinaryNode& node, Extent& place) {
        const std::uint32_t count = blocks_of(node);
        const std::size_t offset = place.blocks[node.kind];
        place.blocks[node.kind] += count;
        sink_.pack(node.kind, offset, references_.subspan(node.begin, node.size()));
        return NodeRef::leaf(node.kind, static_cast<std::uint32_t>(offset), count);
    }
    void set_child(std::size_t number, std::size_t slot, std::uint32_t index, NodeRef child) {
        wide_.nodes[number].set_box(slot, binary_.nodes[index].box);
        wide_.nodes[number].child[slot] = child;
    }

    /// The same with the children in parallel, where there is a plan of them.
    NodeRef emit(std::uint32_t index, const Plan& plan, Extent place) {
        if (plan.children.empty()) return emit(index, place);
        const std::size_t number = place.nodes++;
        const Children all = children(index);
        std::array<Extent, kWidth> places;
        for (std::uint32_t i = 0; i < all.count; ++i) {
            places[i] = place;
            place.add(plan.children[i].extent);
        }
        parallel_for(all.count, 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                set_child(number, i, all.node[i], emit(all.node[i], plan.children[i], places[i]));
            }
        });
        wide_.nodes[number].set_order();
        return NodeRef::node(static_cast<std::uint32_t>(number));
    }

    const BinaryBvh& binary_;
    std::span<const BuildReference> references_;
    LeafKinds kinds_;
    LeafSink& sink_;
    std::unique_ptr<Choice[]> choices_;
    WideBvh wide_;
};

}  // namespace

WideBvh collapse(const BinaryBvh& binary, std::span<const BuildReference> references,
                 const LeafKinds& kinds, LeafSink& sink) {
    if (binary.empty) return {};
    return Collapse(binary, references, kinds, sink).run();
}

}  // namespace alhazen
