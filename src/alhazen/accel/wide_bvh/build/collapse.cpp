#include "alhazen/accel/wide_bvh/build/collapse.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <vector>

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

/// The cheapest conversions of the subtree of a binary node to at most i wide subtrees.
template <std::uint32_t kWidth>
struct ChoiceOf {
    std::array<std::uint8_t, kWidth> lefts;  ///< [i - 1] number for the left child, 0: as for i - 1
    std::uint8_t inner_left;                 ///< as left(kWidth), for a wide node made of this node
    bool as_leaf;                            ///< the single subtree is a leaf

    [[nodiscard]] std::uint32_t left(std::uint32_t i) const { return lefts[i - 1]; }
    /// The number of subtrees made of at most i.
    [[nodiscard]] std::uint32_t used(std::uint32_t i) const {
        if constexpr (kWidth == 8 && std::endian::native == std::endian::little) {
            // The highest byte that is not 0, of the lowest i.
            std::uint64_t all;
            std::memcpy(&all, lefts.data(), sizeof(all));
            all &= ~std::uint64_t{0} >> (64 - 8 * i);
            return (static_cast<std::uint32_t>(std::bit_width(all | 1)) + 7) / 8;
        }
        while (i > 1 && left(i) == 0) --i;
        return i;
    }
};

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

/// Four numbers of subtrees in lanes.
struct SpreadLanes {
    Float4 cost{kNever, kNever, kNever, kNever};
    Int4 left{1, 1, 1, 1}, chosen;

    void offer(float left_cost, Float4 right_cost, int left_count) {
        const Float4 sum = left_cost + right_cost;
        const Int4 better = sum < cost;
        left = (better & left_count) | (~better & left);
        cost = lesser(sum, cost);
    }
    /// Stores the least costs, where `before` are the costs of one subtree less; `chosen` is the
    /// left number where it is better than these, else 0.
    void choose(Float4 before, Float4 one, float* costs) {
        chosen = left & (cost < one) & (cost < before);
        const Float4 least = lesser(cost, one);
        std::memcpy(costs, &least, sizeof(least));
    }
};

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

/// The same in lanes. The costs of a spread do not increase with the number of subtrees, as those
/// of the children do not: the least one so far is that of the number before, or of one subtree.
template <>
ChoiceOf<8> weigh<8>(const CostsOf<8>& l, const CostsOf<8>& r, float area, float as_leaf,
                     CostsOf<8>& costs) {
    const Float4 none{kNever, kNever, kNever, kNever};
    Float4 r0, r1;
    std::memcpy(&r0, r.data(), sizeof(r0));
    std::memcpy(&r1, r.data() + 4, sizeof(r1));
    // The right child's costs for 1 to 3 subtrees less than lanes 0 to 3 have.
    const Float4 less1 = __builtin_shufflevector(none, r0, 0, 4, 5, 6);
    const Float4 less2 = __builtin_shufflevector(none, r0, 0, 1, 4, 5);
    const Float4 less3 = __builtin_shufflevector(none, r0, 0, 1, 2, 4);
    SpreadLanes low, high;
    low.offer(l[0], less1, 1);
    low.offer(l[1], less2, 2);
    low.offer(l[2], less3, 3);
    high.offer(l[0], __builtin_shufflevector(r0, r1, 3, 4, 5, 6), 1);
    high.offer(l[1], __builtin_shufflevector(r0, r1, 2, 3, 4, 5), 2);
    high.offer(l[2], __builtin_shufflevector(r0, r1, 1, 2, 3, 4), 3);
    high.offer(l[3], r0, 4);
    high.offer(l[4], less1, 5);
    high.offer(l[5], less2, 6);
    high.offer(l[6], less3, 7);
    const float inner = area + high.cost[3];
    const float one = std::min(as_leaf, inner);
    const Float4 ones{one, one, one, one};
    low.choose(__builtin_shufflevector(none, low.cost, 0, 4, 5, 6), ones, costs.data());
    high.choose(__builtin_shufflevector(low.cost, high.cost, 3, 4, 5, 6), ones,
                costs.data() + 4);
    ChoiceOf<8> choice;
    choice.as_leaf = as_leaf <= inner && as_leaf < kNever;
    choice.inner_left = static_cast<std::uint8_t>(high.left[3]);
#ifdef __SSE2__
    const __m128i words = _mm_packs_epi32((__m128i)low.chosen, (__m128i)high.chosen);
    const __m128i bytes = _mm_packus_epi16(words, words);
    std::memcpy(choice.lefts.data(), &bytes, 8);
#else
    for (int i = 0; i < 4; ++i) {
        choice.lefts[static_cast<std::size_t>(i)] = static_cast<std::uint8_t>(low.chosen[i]);
        choice.lefts[static_cast<std::size_t>(i) + 4] = static_cast<std::uint8_t>(high.chosen[i]);
    }
#endif
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

/// Properties of a wide subtree.
struct Plan {
    Extent extent;
    int depth = 0;               ///< levels of inner nodes
    std::vector<Plan> children;  ///< only if they are separate tasks

    void add(const Plan& child) {
        extent.add(child.extent);
        depth = std::max(depth, child.depth);
    }
};

/// The binary nodes that become the children of a wide node.
template <std::uint32_t kWidth>
struct ChildrenOf {
    std::array<std::uint32_t, kWidth> node;
    std::uint32_t count = 0;
};

/// A written subtree: its reference, and its properties for any-hit queries.
struct Emitted {
    NodeRef ref;
    float surface = 0;  ///< area of its surfaces
    float cost = 0;     ///< expected cost of a line that intersects its box and passes through
};

/// Visiting priority of a child, larger first: the probability of a hit over the cost.
float visit_priority(const Emitted& child, const FloatBox& box) {
    return (1.0f - std::exp(-child.surface / box.weight())) / child.cost;
}

/// The children from the largest promise to the least, those of equal ones in their order: by ranks,
/// without branches.
template <std::size_t Width>
std::array<std::uint32_t, Width> by_promise(const std::array<float, Width>& promise,
                                            std::uint32_t count) {
    std::array<std::uint32_t, Width> order{}, rank{};
    for (std::size_t first = 0; first < count; first += 4) {
        Float4 here;
        std::memcpy(&here, promise.data() + first, sizeof(here));
        const Int4 lane = Int4{0, 1, 2, 3} + static_cast<int>(first);
        Int4 ranks{};
        for (std::uint32_t i = 0; i < count; ++i) {
            const Float4 other = Float4{} + promise[i];
            const Int4 before = Int4{} + static_cast<int>(i) < lane;
            ranks -= (other > here) | ((other == here) & before);  // -1 where true
        }
        std::memcpy(rank.data() + first, &ranks, sizeof(ranks));
    }
    for (std::uint32_t i = 0; i < count; ++i) order[rank[i]] = i;
    return order;
}

/// As WideNodeOf::set_order. Ranks the children of all octants at once, one octant per lane,
/// without branches, as the order is unpredictable.
template <std::size_t Width>
void set_order(WideNodeOf<Width>& node, std::uint32_t used) {
    Float4 along[Width];
    Int4 rank[Width];  // from the farthest
    for (std::uint32_t i = 0; i < used; ++i) {
        float center2[3];
        for (std::size_t k = 0; k < 3; ++k) center2[k] = node.planes[k][i] + node.planes[k + 3][i];
        const Float4 here = Float4{center2[0], -center2[0], center2[0], -center2[0]} +
                            Float4{center2[1], center2[1], -center2[1], -center2[1]} +
                            Float4{center2[2], center2[2], center2[2], center2[2]};
        along[i] = here;
        Int4 sooner = Int4{} + static_cast<int>(i);
        for (std::uint32_t k = 0; k < i; ++k) {
            const Int4 later = along[k] < here;  // -1 where true
            rank[k] -= later;
            sooner += later;
        }
        rank[i] = sooner;
    }
    using Order = typename WideNodeOf<Width>::Order;
    constexpr std::uint32_t kBits = WideNodeOf<Width>::kSlotBits;
    std::uint64_t all[4]{}, across[4]{};  // the opposite octant has the reverse order
    for (std::uint32_t i = 0; i < used; ++i) {
        for (int octant = 0; octant < 4; ++octant) {
            const auto place = static_cast<std::uint32_t>(rank[i][octant]);
            all[octant] |= std::uint64_t{i} << kBits * place;
            across[octant] |= std::uint64_t{i} << kBits * (used - 1 - place);
        }
    }
    std::uint64_t free = 0;  // free slots keep their place
    for (std::uint32_t i = used; i < Width; ++i) free |= std::uint64_t{i} << kBits * i;
    for (std::size_t octant = 0; octant < 4; ++octant) {
        node.order[octant] = static_cast<Order>(all[octant] | free);
        node.order[7 - octant] = static_cast<Order>(across[octant] | free);
    }
}

/// Three passes: choose the conversion of each binary node, bottom-up; count the nodes and blocks
/// of each wide subtree; write all subtrees, each at its position.
template <std::uint32_t kWidth>
class WideCollapse {
    using Choice = ChoiceOf<kWidth>;
    using Costs = CostsOf<kWidth>;
    using Children = ChildrenOf<kWidth>;
    using Node = WideNodeOf<kWidth>;

  public:
    WideCollapse(const BinaryBvh& binary, std::span<const BuildReference> references,
                 const LeafKinds& kinds, LeafSink& sink)
        : binary_(binary),
          references_(references),
          kinds_(kinds),
          sink_(sink),
          choices_(make_huge_array<Choice>(binary.index_count)) {}

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
        choices_[index] =
            weigh<kWidth>(of_left, of_right, area, leaf_cost(node, area), costs);
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
        divide(index, choices_[index].inner_left, kWidth, out);
        return out;
    }

    [[nodiscard]] std::uint32_t blocks_of(const BinaryNode& node) const {
        return kinds_[node.kind].blocks(node.size());
    }

    [[nodiscard]] Plan plan(std::uint32_t index, int depth) const {
        Plan sum;
        if (choices_[index].as_leaf || !is_task(binary_.nodes[index])) {
            count(index, depth, sum);
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
    /// Adds what a wide subtree has.
    void count(std::uint32_t index, int depth, Plan& sum) const {
        if (choices_[index].as_leaf) return count_leaf(index, sum);
        ++sum.extent.nodes;
        sum.depth = std::max(sum.depth, depth);
        if (depth > kMaxWideDepth) return;
        const Children all = children(index);
        for (std::uint32_t i = 0; i < all.count; ++i) {
            if (choices_[all.node[i]].as_leaf) {
                count_leaf(all.node[i], sum);
            } else {
                count(all.node[i], depth + 1, sum);
            }
        }
    }
    void count_leaf(std::uint32_t index, Plan& sum) const {
        const BinaryNode& node = binary_.nodes[index];
        sum.extent.blocks[node.kind] += blocks_of(node);
    }

    /// Writes a subtree from `place` on, and advances `place` past it.
    Emitted emit(std::uint32_t index, Extent& place) {
        const BinaryNode& node = binary_.nodes[index];
        if (choices_[index].as_leaf) return emit_leaf(node, place);
        const std::size_t number = place.nodes++;
        const Children all = children(index);
        std::array<Emitted, kWidth> emitted;
        for (std::uint32_t i = 0; i < all.count; ++i) emitted[i] = emit(all.node[i], place);
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
        if (plan.children.empty()) return emit(index, place);
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
        std::array<float, kWidth> promise{};
        for (std::uint32_t i = 0; i < all.count; ++i) {
            const FloatBox& box = binary_.nodes[all.node[i]].box;
            sum.surface += emitted[i].surface;
            sum.cost += emitted[i].cost * box.weight();
            // Ranks of what is no number would not be a permutation.
            const float priority = visit_priority(emitted[i], box);
            promise[i] = priority >= 0 ? priority : 0;
        }
        const auto order = by_promise(promise, all.count);
        sum.cost = 1.0f + sum.cost / binary_.nodes[index].box.weight();
        Node& node = nodes_[number];
        for (std::uint32_t slot = 0; slot < all.count; ++slot) {
            node.set_box(slot, binary_.nodes[all.node[order[slot]]].box);
            node.child[slot] = emitted[order[slot]].ref;
        }
        set_order(node, all.count);
        return sum;
    }

    const BinaryBvh& binary_;
    std::span<const BuildReference> references_;
    LeafKinds kinds_;
    LeafSink& sink_;
    HugeArray<Choice> choices_;
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
