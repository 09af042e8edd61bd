#include "alhazen/accel/wide_bvh/build/collapse.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <limits>
#include <cstring>
#include <span>
#include <vector>

#include "alhazen/accel/wide_bvh/build/child_boxes.h"
#include "alhazen/accel/wide_bvh/build/collapse_choice.h"
#include "alhazen/accel/wide_bvh/build/sah_split.h"
#include "alhazen/base/error.h"
#include "alhazen/parallel/parallel.h"
#include "alhazen/parallel/touch_pages.h"

namespace alhazen {
namespace {

constexpr float kNever = std::numeric_limits<float>::infinity();
/// Subtrees of at least this many references are separate tasks.
constexpr std::uint32_t kTaskSize = 1024;

/// [i - 1] The least cost of the subtree of a binary node as at most i wide subtrees.
template <std::uint32_t kWidth>
using CostsOf = std::array<float, kWidth>;

/// [j - 1] The least cost of a node's two children as at most j subtrees in all, and the number of
/// the left child's among these; an infinite cost for j = 1.
template <std::uint32_t kWidth>
struct SpreadOf {
    std::array<float, kWidth> cost;
    std::array<std::uint32_t, kWidth> left;
};

/// `l` and `r` are the costs of the children.
template <std::uint32_t kWidth>
SpreadOf<kWidth> spread_of(const CostsOf<kWidth>& l, const CostsOf<kWidth>& r) {
    SpreadOf<kWidth> spread;
    for (std::uint32_t j = 1; j <= kWidth; ++j) {
        float least = kNever;
        std::uint32_t at = 1;
        for (std::uint32_t k = 1; k < j; ++k) {
            const float cost = l[k - 1] + r[j - k - 1];
            at = cost < least ? k : at;
            least = cost < least ? cost : least;
        }
        spread.cost[j - 1] = least;
        spread.left[j - 1] = at;
    }
    return spread;
}

/// Sets the costs of an inner node of the binary tree from those of its children.
template <std::uint32_t kWidth>
ChoiceOf<kWidth> weigh(const CostsOf<kWidth>& l, const CostsOf<kWidth>& r, float area,
                       float as_leaf, CostsOf<kWidth>& costs) {
    const SpreadOf<kWidth> spread = spread_of<kWidth>(l, r);
    const float inner = area + spread.cost[kWidth - 1];
    ChoiceOf<kWidth> choice;
    choice.as_leaf = as_leaf <= inner && as_leaf < kNever;
    choice.inner_left = static_cast<std::uint8_t>(spread.left[kWidth - 1]);
    float least = std::min(as_leaf, inner);
    costs[0] = least;
    choice.lefts[0] = 0;
    for (std::uint32_t i = 1; i < kWidth; ++i) {
        const bool better = spread.cost[i] < least;
        choice.lefts[i] = static_cast<std::uint8_t>(better ? spread.left[i] : 0);
        least = better ? spread.cost[i] : least;
        costs[i] = least;
    }
    return choice;
}

/// Numbers of nodes and blocks of a wide subtree, or their start indices.
struct Extent {
    std::size_t nodes = 0;
    std::array<std::size_t, kLeafKinds> blocks{};

    void add(const Extent& other) {
        nodes += other.nodes;
        for (std::size_t k = 0; k < kLeafKinds; ++k) blocks[k] += other.blocks[k];
    }
};

/// The binary nodes that become the children of a wide node.
template <std::uint32_t kWidth>
struct ChildrenOf {
    std::array<std::uint32_t, kWidth> node;
    std::uint32_t count;
};

/// Properties of a wide subtree.
template <std::uint32_t kWidth>
struct PlanOf {
    Extent extent;
    int depth = 0;                 ///< levels of inner nodes
    std::vector<PlanOf> children;  ///< only if they are separate tasks
    /// The children of all nodes if they are not, in the order of the nodes.
    std::span<const ChildrenOf<kWidth>> nodes;

    void add(const PlanOf& child) {
        extent.add(child.extent);
        depth = std::max(depth, child.depth);
    }
};

/// A written subtree: its reference, and its properties for any-hit queries.
struct Emitted {
    NodeRef ref;
    float surface = 0;  ///< area of its surfaces
    float cost = 0;     ///< expected cost of a line that intersects its box and passes through
};

/// Three passes: choose the conversion of each binary node, bottom-up; count the nodes and blocks
/// of each wide subtree; write all subtrees, each at its position.
template <std::uint32_t kWidth>
class WideCollapse {
    using Choice = ChoiceOf<kWidth>;
    using Costs = CostsOf<kWidth>;
    using Children = ChildrenOf<kWidth>;
    using Plan = PlanOf<kWidth>;
    using Node = WideNodeOf<kWidth>;

  public:
    WideCollapse(const BinaryBvh& binary, std::span<const BuildReference> references,
                 const LeafKinds& kinds, LeafSink& sink)
        : binary_(binary),
          references_(references),
          kinds_(kinds),
          sink_(sink),
          choices_(make_huge_array<Choice>(binary.index_count)),
          lists_(make_huge_array<Children>(binary.index_count / 2 + 1)) {}

    WideBvh run() {
        Costs costs;
        choose(0, costs);
        const Plan all = plan(0, 1);
        const auto& blocks = all.extent.blocks;
        if (all.depth > kMaxWideDepth || all.extent.nodes >= NodeRef::kMaxNodes ||
            *std::max_element(blocks.begin(), blocks.end()) > NodeRef::kMaxOffset) {
            throw Error(ErrorKind::Resource, "too many primitives for one wide BVH");
        }
        wide_.empty = false;
        wide_.depth = all.depth;
        wide_.width = kWidth;
        auto& nodes = nodes_of<kWidth>(wide_);
        nodes.reserve(all.extent.nodes);
        touch_pages(nodes.data(), all.extent.nodes * sizeof(Node));
        nodes.resize(all.extent.nodes);
        nodes_ = nodes.data();
        sink_.resize(blocks);
        wide_.root = emit(0, all, {}).ref;
        return std::move(wide_);
    }

  private:
    [[nodiscard]] static bool is_task(const BinaryNode& node) { return node.size() >= kTaskSize; }

    void choose(std::uint32_t index, Costs& costs) {
        const BinaryNode& node = binary_.nodes[index];
        if (node.is_leaf()) return choose_leaf(index, node, costs);
        Costs of_left, of_right;
        if (is_task(node)) {
            parallel_invoke([&] { choose(index + 1, of_left); },
                            [&] { choose(node.right, of_right); });
        } else {
            choose_child(index + 1, of_left);
            choose_child(node.right, of_right);
        }
        const float area = node.box.weight();
        const float as_leaf = leaf_cost(node, area);
        if constexpr (kWidth == 8) {
            choices_[index] =
                choose_eight_(of_left.data(), of_right.data(), area, as_leaf, costs.data());
        } else {
            choices_[index] = weigh<kWidth>(of_left, of_right, area, as_leaf, costs);
        }
    }
    /// As `choose`. Half of the nodes are leaves: they are not worth a call.
    void choose_child(std::uint32_t index, Costs& costs) {
        const BinaryNode& node = binary_.nodes[index];
        if (node.is_leaf()) {
            choose_leaf(index, node, costs);
        } else {
            choose(index, costs);
        }
    }
    void choose_leaf(std::uint32_t index, const BinaryNode& node, Costs& costs) {
        const float as_leaf = leaf_cost(node, node.box.weight());
        const Float4 four{as_leaf, as_leaf, as_leaf, as_leaf};
        for (std::size_t i = 0; i < kWidth; i += 4) {
            std::memcpy(costs.data() + i, &four, sizeof(four));
        }
        choices_[index] = {{}, 0, true};
    }

    [[nodiscard]] float leaf_cost(const BinaryNode& node, float area) const {
        if (node.kind == kLeafKinds) return kNever;
        const LeafKind& kind = kinds_[node.kind];
        const std::uint32_t blocks = kind.blocks(node.size());
        if (blocks > NodeRef::kMaxBlocks) return kNever;
        return area * kind.cost * static_cast<float>(blocks);
    }

    /// Appends the subtrees, at most `budget`, chosen for a subtree.
    void gather(std::uint32_t index, std::uint32_t budget, Children& out) const {
        const Choice& choice = choices_[index];
        budget = choice.used(budget);
        if (budget == 1) {
            out.node[out.count++] = index;
        } else {
            divide(index, choice.left(budget), budget, out);
        }
    }
    void divide(std::uint32_t index, std::uint32_t left, std::uint32_t budget,
                Children& out) const {
        gather(index + 1, left, out);
        gather(binary_.nodes[index].right, budget - left, out);
    }
    [[nodiscard]] Children children(std::uint32_t index) const {
        Children out;
        out.count = 0;
        divide(index, choices_[index].inner_left, kWidth, out);
        return out;
    }

    [[nodiscard]] std::uint32_t blocks_of(const BinaryNode& node) const {
        return kinds_[node.kind].blocks(node.size());
    }

    [[nodiscard]] Plan plan(std::uint32_t index, int depth) {
        Plan sum;
        if (choices_[index].as_leaf || !is_task(binary_.nodes[index])) {
            std::array<Children, kTaskSize> nodes;  // fewer than references
            Children* last = nodes.data();
            count(index, depth, sum, last);
            const auto size = static_cast<std::size_t>(last - nodes.data());
            Children* const kept = lists_.get() + listed_.fetch_add(size);
            std::copy(nodes.data(), last, kept);
            sum.nodes = {kept, size};
            return sum;
        }
        sum.extent.nodes = 1;
        sum.depth = depth;
        // A tree that is too deep is rejected; its size does not matter.
        if (depth > kMaxWideDepth) return sum;
        const Children all = children(index);
        sum.children.resize(all.count);
        parallel_for(all.count, 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                sum.children[i] = plan(all.node[i], depth + 1);
            }
        });
        for (const Plan& child : sum.children) sum.add(child);
        return sum;
    }
    /// Adds what a wide subtree has, and lists the children of its nodes.
    void count(std::uint32_t index, int depth, Plan& sum, Children*& list) const {
        if (choices_[index].as_leaf) return count_leaf(index, sum);
        ++sum.extent.nodes;
        sum.depth = std::max(sum.depth, depth);
        if (depth > kMaxWideDepth) return;
        const Children& all = *list++ = children(index);
        for (std::uint32_t i = 0; i < all.count; ++i) {
            if (choices_[all.node[i]].as_leaf) {
                count_leaf(all.node[i], sum);
            } else {
                count(all.node[i], depth + 1, sum, list);
            }
        }
    }
    void count_leaf(std::uint32_t index, Plan& sum) const {
        const BinaryNode& node = binary_.nodes[index];
        sum.extent.blocks[node.kind] += blocks_of(node);
    }

    /// Writes a subtree from `place` on, and advances `place` past it, and `list` past the children
    /// of its nodes.
    Emitted emit(std::uint32_t index, Extent& place, const Children*& list) {
        if (choices_[index].as_leaf) return emit_leaf(binary_.nodes[index], place);
        const std::size_t number = place.nodes++;
        const Children& all = *list++;
        std::array<Emitted, kWidth> emitted;
        for (std::uint32_t i = 0; i < all.count; ++i) emitted[i] = emit(all.node[i], place, list);
        return emit_node(number, index, all, emitted);
    }
    Emitted emit_leaf(const BinaryNode& node, Extent& place) {
        const std::uint32_t count = blocks_of(node);
        const std::size_t offset = place.blocks[node.kind];
        place.blocks[node.kind] += count;
        const float surface =
            sink_.pack(node.kind, offset, references_.subspan(node.begin, node.size()));
        return {NodeRef::leaf(node.kind, static_cast<std::uint32_t>(offset), count), surface,
                kinds_[node.kind].cost * static_cast<float>(count)};
    }

    /// The same with the children in parallel, if they have plans.
    Emitted emit(std::uint32_t index, const Plan& plan, Extent place) {
        if (plan.children.empty()) {
            const Children* list = plan.nodes.data();
            return emit(index, place, list);
        }
        const std::size_t number = place.nodes++;
        const Children all = children(index);
        std::array<Extent, kWidth> places;
        for (std::uint32_t i = 0; i < all.count; ++i) {
            places[i] = place;
            place.add(plan.children[i].extent);
        }
        std::array<Emitted, kWidth> emitted;
        parallel_for(all.count, 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                emitted[i] = emit(all.node[i], plan.children[i], places[i]);
            }
        });
        return emit_node(number, index, all, emitted);
    }

    /// Writes a node above its children, the most promising child first.
    Emitted emit_node(std::size_t number, std::uint32_t index, const Children& all,
                      const std::array<Emitted, kWidth>& emitted) {
        Emitted sum{NodeRef::node(static_cast<std::uint32_t>(number)), 0, 0};
        ChildBoxes<kWidth> boxes;
        for (std::uint32_t i = 0; i < all.count; ++i) boxes.set(i, binary_.nodes[all.node[i]]);
        const std::array<float, kWidth> weights = boxes.weights(all.count);
        std::array<float, kWidth> promise{};
        for (std::uint32_t i = 0; i < all.count; ++i) {
            sum.surface += emitted[i].surface;
            sum.cost += emitted[i].cost * weights[i];
            // The probability of a hit over the cost. Ranks of what is no number would not be a
            // permutation.
            const float hit = 1.0f - std::exp(-emitted[i].surface / weights[i]);
            const float priority = hit / emitted[i].cost;
            promise[i] = priority >= 0 ? priority : 0;
        }
        const auto order = by_promise(promise, all.count);
        sum.cost = 1.0f + sum.cost / binary_.nodes[index].box.weight();
        Node& node = nodes_[number];
        for (std::uint32_t slot = 0; slot < all.count; ++slot) {
            boxes.set(slot, binary_.nodes[all.node[order[slot]]]);
            node.child[slot] = emitted[order[slot]].ref;
        }
        boxes.store(node);
        set_order(node, boxes, all.count);
        return sum;
    }

    const BinaryBvh& binary_;
    std::span<const BuildReference> references_;
    LeafKinds kinds_;
    LeafSink& sink_;
    ChooseEight choose_eight_ = choose_eight();
    HugeArray<Choice> choices_;
    HugeArray<Children> lists_;  ///< of the subtrees that are not divided into tasks
    std::atomic<std::size_t> listed_{0};
    WideBvh wide_;
    Node* nodes_ = nullptr;
};

}  // namespace

WideBvh collapse(const BinaryBvh& binary, std::span<const BuildReference> references,
                 const LeafKinds& kinds, LeafSink& sink, std::uint32_t width) {
    if (binary.empty) return {};
    if (width == 4) return WideCollapse<4>(binary, references, kinds, sink).run();
    if (width == 16) return WideCollapse<16>(binary, references, kinds, sink).run();
    return WideCollapse<8>(binary, references, kinds, sink).run();
}

}  // namespace alhazen
