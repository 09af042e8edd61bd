#include "alhazen/accel/wide_bvh/build/tree_draft.h"

#include <algorithm>

#include "alhazen/accel/wide_bvh/build/sah_split.h"
#include "alhazen/parallel/parallel.h"

namespace alhazen {
namespace {

/// Height below kMaxSahLevel that needs no balancing: that of a balanced tree of 2^32 leaves.
constexpr std::uint32_t kHeightLeft = 32;

class Linearizer {
  public:
    Linearizer(const DraftBvh& draft, std::span<const BuildReference> references)
        : draft_(draft), references_(references), sums_(draft.nodes.size()) {}

    BinaryBvh run(std::vector<BuildReference>& ordered) {
        measure();
        const Sums& all = sums_[draft_.root];
        ordered_.resize(all.references);
        BinaryBvh tree{make_huge_array<BinaryNode>(2 * all.leaves - 1), 2 * all.leaves - 1, false};
        nodes_ = tree.nodes.get();
        write(draft_.root, 0, 0, 0);
        ordered = std::move(ordered_);
        return tree;
    }

  private:
    struct Sums {
        std::uint32_t leaves, references, height;
    };

    /// Without recursion: a draft may be as deep as its number of nodes.
    void measure() {
        std::vector<std::uint32_t> order{draft_.root};
        order.reserve(draft_.nodes.size());
        for (std::size_t i = 0; i < order.size(); ++i) {
            const DraftNode& node = draft_.nodes[order[i]];
            if (node.is_leaf()) continue;
            order.push_back(node.left);
            order.push_back(node.right);
        }
        for (auto i = order.rbegin(); i != order.rend(); ++i) {
            const DraftNode& node = draft_.nodes[*i];
            if (node.is_leaf()) {
                sums_[*i] = {1, node.end - node.begin, 0};
                continue;
            }
            const Sums &l = sums_[node.left], &r = sums_[node.right];
            sums_[*i] = {l.leaves + r.leaves, l.references + r.references,
                         1 + std::max(l.height, r.height)};
        }
    }

    void write(std::uint32_t index, std::uint32_t place, std::uint32_t begin, int level) {
        const DraftNode& node = draft_.nodes[index];
        const Sums& sums = sums_[index];
        if (node.is_leaf()) return write_leaf(node, place, begin);
        if (level >= kMaxSahLevel && sums.height > kHeightLeft) {
            std::vector<std::uint32_t> leaves = leaves_of(index);
            return write_balanced(leaves, place, begin);
        }
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
        std::copy(references_.begin() + node.begin, references_.begin() + node.end,
                  ordered_.begin() + begin);
        nodes_[place] = {node.box, begin, begin + (node.end - node.begin), 0,
                         references_[node.begin].kind};
    }

    /// Makes the inner node at `place` of its two existing children.
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

    /// Writes leaves in their order, half of them on each side.
    void write_balanced(std::span<const std::uint32_t> leaves, std::uint32_t place,
                        std::uint32_t begin) {
        if (leaves.size() == 1) return write_leaf(draft_.nodes[leaves[0]], place, begin);
        const std::size_t half = leaves.size() / 2;
        const std::uint32_t right = place + 2 * static_cast<std::uint32_t>(half);
        write_balanced(leaves.first(half), place + 1, begin);
        write_balanced(leaves.subspan(half), right, nodes_[place + 1].end);
        join(place, right);
    }

    const DraftBvh& draft_;
    std::span<const BuildReference> references_;
    std::vector<Sums> sums_;
    std::vector<BuildReference> ordered_;
    BinaryNode* nodes_ = nullptr;
};

}  // namespace

namespace {

/// The least sum of the areas of blocks for the references of a subtree.
float block_area(const BinaryBvh& tree, std::uint32_t index, const LeafKinds& kinds) {
    const BinaryNode& node = tree.nodes[index];
    const float area = node.box.weight();
    if (node.is_leaf()) return area;
    const float apart = block_area(tree, index + 1, kinds) + block_area(tree, node.right, kinds);
    return node.kind != kLeafKinds && node.size() <= kinds[node.kind].width()
               ? std::min(area, apart)
               : apart;
}

/// Whether a subtree is best kept in one block.
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

BinaryBvh linearize(const DraftBvh& draft, std::vector<BuildReference>& references) {
    if (draft.nodes.empty()) return {};
    std::vector<BuildReference> ordered;
    BinaryBvh tree = Linearizer(draft, references).run(ordered);
    references = std::move(ordered);
    return tree;
}

}  // namespace alhazen
