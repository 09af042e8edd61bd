#include "alhazen/accel/wide_bvh/build/tree_draft.h"

#include <algorithm>

#include "alhazen/accel/wide_bvh/build/sah_split.h"
#include "alhazen/parallel/parallel.h"

namespace alhazen {
namespace {

/// Height below kMaxSahLevel that needs no rebalancing: that of a balanced tree of 2^32 leaves.
constexpr std::uint32_t kHeightLeft = 32;

class Linearizer {
  public:
    Linearizer(const DraftView& draft, std::span<const BuildReference> references)
        : draft_{draft.nodes.data(), draft.nodes.size(), draft.root},
          references_(references.data()),
          sums_(make_huge_array<Sums>(draft.nodes.size())) {
        if (!measure_upwards()) measure();
    }

    /// Number of references in the leaves.
    [[nodiscard]] std::size_t size() const { return sums_[draft_.root].references; }

    /// `ordered`: capacity for all references.
    BinaryBvh run(BuildReference* ordered) {
        ordered_ = ordered;
        const std::uint32_t count = 2 * sums_[draft_.root].leaves - 1;
        BinaryBvh tree{make_huge_array<BinaryNode>(count), count, false};
        nodes_ = tree.nodes.get();
        write(draft_.root, 0, 0, 0);
        return tree;
    }

  private:
    struct Sums {
        std::uint32_t leaves, references, height;
    };

    struct Draft {
        const DraftNode* nodes;
        std::size_t size;
        std::uint32_t root;
    };

    void measure(std::size_t index) {
        const DraftNode& node = draft_.nodes[index];
        if (node.is_leaf()) {
            sums_[index] = {1, node.end - node.begin, 0};
            return;
        }
        const Sums &l = sums_[node.left], &r = sums_[node.right];
        sums_[index] = {l.leaves + r.leaves, l.references + r.references,
                        1 + std::max(l.height, r.height)};
    }
    /// Only for a draft made bottom-up, with every node after its children; else returns false.
    bool measure_upwards() {
        for (std::size_t i = 0; i < draft_.size; ++i) {
            const DraftNode& node = draft_.nodes[i];
            if (!node.is_leaf() && (node.left >= i || node.right >= i)) return false;
            measure(i);
        }
        return true;
    }
    /// Without recursion: a draft may be as deep as its number of nodes.
    void measure() {
        std::vector<std::uint32_t> order{draft_.root};
        order.reserve(draft_.size);
        for (std::size_t i = 0; i < order.size(); ++i) {
            const DraftNode& node = draft_.nodes[order[i]];
            if (node.is_leaf()) continue;
            order.push_back(node.left);
            order.push_back(node.right);
        }
        for (auto i = order.rbegin(); i != order.rend(); ++i) measure(*i);
    }

    void write(std::uint32_t index, std::uint32_t place, std::uint32_t begin, int level) {
        const DraftNode& node = draft_.nodes[index];
        const Sums& sums = sums_[index];
        if (node.is_leaf()) return write_leaf(node, place, begin);
        if (level >= kMaxSahLevel && sums.height > kHeightLeft) {
            std::vector<std::uint32_t> leaves = leaves_of(index);
            return write_balanced(leaves, place, begin);
        }
        __builtin_prefetch(&draft_.nodes[node.right]);
        __builtin_prefetch(&sums_[node.right]);
        const Sums& left_sums = sums_[node.left];
        const std::uint32_t right = place + 2 * left_sums.leaves;
        const auto write_left = [&] { write(node.left, place + 1, begin, level + 1); };
        const auto write_right = [&] {
            write(node.right, right, begin + left_sums.references, level + 1);
        };
        if (sums.references >= kParallelBuildSize) {
            parallel_invoke(write_left, write_right);
        } else {
            write_left();
            write_right();
        }
        join(place, right);
    }

    void write_leaf(const DraftNode& node, std::uint32_t place, std::uint32_t begin) {
        // Few references: a call does not pay.
        for (std::uint32_t i = node.begin; i < node.end; ++i) {
            ordered_[begin + (i - node.begin)] = references_[i];
        }
        nodes_[place] = {node.box, begin, begin + (node.end - node.begin), 0,
                         references_[node.begin].kind};
    }

    /// Makes the inner node at index `place` from its two existing children.
    void join(std::uint32_t place, std::uint32_t right) {
        const BinaryNode &l = nodes_[place + 1], &r = nodes_[right];
        FloatBox box = l.box;
        box.include(r.box);
        nodes_[place] = {box, l.begin, r.end, right,
                         l.kind == r.kind ? l.kind : std::uint32_t{kLeafKinds}};
    }

    [[nodiscard]] std::vector<std::uint32_t> leaves_of(std::uint32_t index) const {
        std::vector<std::uint32_t> leaves, stack{index};
        while (!stack.empty()) {
            const std::uint32_t top = stack.back();
            const DraftNode& node = draft_.nodes[top];
            stack.pop_back();
            if (node.is_leaf()) {
                leaves.push_back(top);
            } else {
                stack.push_back(node.right);
                stack.push_back(node.left);
            }
        }
        return leaves;
    }

    /// Writes leaves in their order as a balanced tree.
    void write_balanced(std::span<const std::uint32_t> leaves, std::uint32_t place,
                        std::uint32_t begin) {
        if (leaves.size() == 1) return write_leaf(draft_.nodes[leaves[0]], place, begin);
        const std::size_t half = leaves.size() / 2;
        const std::uint32_t right = place + 2 * static_cast<std::uint32_t>(half);
        write_balanced(leaves.first(half), place + 1, begin);
        write_balanced(leaves.subspan(half), right, nodes_[place + 1].end);
        join(place, right);
    }

    Draft draft_;
    const BuildReference* references_;
    HugeArray<Sums> sums_;
    BuildReference* ordered_ = nullptr;
    BinaryNode* nodes_ = nullptr;
};

}  // namespace

namespace {

/// The minimum sum of the areas of blocks for the references of a subtree.
float block_area(const BinaryBvh& tree, std::uint32_t index, const LeafKinds& kinds) {
    const BinaryNode& node = tree.nodes[index];
    const float area = node.box.weight();
    if (node.is_leaf()) return area;
    const float apart = block_area(tree, index + 1, kinds) + block_area(tree, node.right, kinds);
    return node.kind != kLeafKinds && node.size() <= kinds[node.kind].width()
               ? std::min(area, apart)
               : apart;
}

/// True if a subtree is best kept in one block.
bool is_block(const BinaryBvh& tree, std::uint32_t index, const LeafKinds& kinds) {
    const BinaryNode& node = tree.nodes[index];
    if (node.is_leaf()) return true;
    return node.kind != kLeafKinds && node.size() <= kinds[node.kind].width() &&
           !(block_area(tree, index, kinds) < node.box.weight());
}

}  // namespace

DraftBvh draft_of(const BinaryBvh& tree, const LeafKinds& kinds) {
    DraftBvh draft;
    if (tree.empty) return draft;
    struct Copy {
        std::uint32_t from, to;
    };
    draft.nodes.emplace_back();
    std::vector<Copy> stack{{0, 0}};
    while (!stack.empty()) {
        const auto [from, to] = stack.back();
        stack.pop_back();
        const BinaryNode& node = tree.nodes[from];
        DraftNode copy{node.box, 0, 0, node.begin, node.end};
        if (!is_block(tree, from, kinds)) {
            copy.left = static_cast<std::uint32_t>(draft.nodes.size());
            copy.right = copy.left + 1;
            draft.nodes.resize(draft.nodes.size() + 2);
            stack.push_back({node.right, copy.right});
            stack.push_back({from + 1, copy.left});
        }
        draft.nodes[to] = copy;
    }
    return draft;
}

double draft_cost(const DraftBvh& draft, std::span<const BuildReference> references,
                  const LeafKinds& kinds) {
    if (draft.nodes.empty()) return 0;
    double cost = 0;
    for (const DraftNode& node : draft.nodes) {
        float visit = 0.5f;
        if (node.is_leaf()) {
            const LeafKind& kind = kinds[references[node.begin].kind];
            visit = kind.cost * static_cast<float>(kind.blocks(node.end - node.begin));
        }
        cost += static_cast<double>(node.box.weight()) * static_cast<double>(visit);
    }
    return cost / static_cast<double>(draft.nodes[draft.root].box.weight());
}

BinaryBvh linearize(const DraftBvh& draft, std::vector<BuildReference>& references) {
    if (draft.nodes.empty()) return {};
    Linearizer linearizer({draft.nodes, draft.root}, references);
    std::vector<BuildReference> ordered(linearizer.size());
    BinaryBvh tree = linearizer.run(ordered.data());
    references = std::move(ordered);
    return tree;
}

BinaryBvh linearize(const DraftView& draft, std::span<const BuildReference> references,
                    std::span<BuildReference> ordered) {
    if (draft.nodes.empty()) return {};
    return Linearizer(draft, references).run(ordered.data());
}

}  // namespace alhazen
