#pragma once
/// The state of a solid at a point that moves along a ray: which leaves contain it, and the values
/// of the nodes above them, relative to the state outside all leaves.
///
/// Conventions: `fit` allocates for a tree; `clear` at the end of a query undoes its changes, so
/// that no work per ray is proportional to the tree.

#include <cstdint>
#include <vector>

#include "alhazen/csg/csg_tree.h"

namespace alhazen {

class CsgState {
  public:
    void fit(const CsgTree& tree) {
        tree_ = &tree;
        if (surplus_.size() < tree.nodes().size()) {
            surplus_.resize(tree.nodes().size(), 0);
            node_changed_.resize(tree.nodes().size(), 0);
        }
        if (leaf_.size() < tree.leaves().size()) leaf_.resize(tree.leaves().size(), 0);
        // The root is false outside all leaves: complements occur only below a difference.
        value_ = tree.nodes().front().need <= 0;
    }
    /// Undoes all changes since `fit`.
    void clear() {
        forget_changes();
        for (const std::uint32_t leaf : touched_) {
            if ((leaf_[leaf] & kInside) != 0) toggle(leaf);
        }
        forget_changes();
        for (const std::uint32_t leaf : touched_) leaf_[leaf] = 0;
        touched_.clear();
    }

    [[nodiscard]] bool value() const { return value_; }
    [[nodiscard]] bool inside(std::uint32_t leaf) const { return (leaf_[leaf] & kInside) != 0; }

    /// Moves the point across the leaf's surface.
    void toggle(std::uint32_t leaf) {
        if (leaf_[leaf] == 0) touched_.push_back(leaf);
        leaf_[leaf] ^= kInside;
        leaf_[leaf] ^= kChanged;
        leaf_[leaf] |= kTouched;
        changed_leaves_.push_back(leaf);
        const CsgTree::Leaf& l = tree_->leaves()[leaf];
        int step = inside(leaf) != l.complement ? 1 : -1;
        std::uint32_t node = l.parent;
        do {
            const CsgTree::Node& n = tree_->nodes()[node];
            const bool was = surplus_[node] >= n.need;
            surplus_[node] += step;
            const bool is = surplus_[node] >= n.need;
            if (was == is) return;
            node_changed_[node] ^= 1;
            changed_nodes_.push_back(node);
            step = is ? 1 : -1;
            node = n.parent;
        } while (node != CsgTree::kNone);
        value_ = !value_;
    }

    /// The lowest-numbered of the leaves that make the point solid; kNone outside. O(leaves that
    /// contain the point times depth).
    [[nodiscard]] std::uint32_t filling_leaf() const {
        std::uint32_t lowest = CsgTree::kNone;
        for (const std::uint32_t leaf : touched_) {
            if (leaf >= lowest || !inside(leaf) || tree_->leaves()[leaf].complement) continue;
            std::uint32_t node = tree_->leaves()[leaf].parent;
            while (node != CsgTree::kNone && surplus_[node] >= tree_->nodes()[node].need) {
                node = tree_->nodes()[node].parent;
            }
            if (node == CsgTree::kNone) lowest = leaf;
        }
        return lowest;
    }
    [[nodiscard]] bool changed(std::uint32_t leaf) const { return (leaf_[leaf] & kChanged) != 0; }

    /// Clears the record of changes.
    void forget_changes() {
        for (const std::uint32_t leaf : changed_leaves_) {
            leaf_[leaf] = static_cast<std::uint8_t>(leaf_[leaf] & ~kChanged);
        }
        for (const std::uint32_t node : changed_nodes_) node_changed_[node] = 0;
        changed_leaves_.clear();
        changed_nodes_.clear();
    }
    /// True if the leaf and all nodes above it have changed since `forget_changes`.
    [[nodiscard]] bool changed_all_the_way(std::uint32_t leaf) const {
        if ((leaf_[leaf] & kChanged) == 0) return false;
        std::uint32_t node = tree_->leaves()[leaf].parent;
        for (; node != CsgTree::kNone; node = tree_->nodes()[node].parent) {
            if (node_changed_[node] == 0) return false;
        }
        return true;
    }

  private:
    enum : std::uint8_t { kInside = 1, kChanged = 2, kTouched = 4 };

    const CsgTree* tree_ = nullptr;
    bool value_ = false;
    /// [node] number of true operands minus that number outside all leaves.
    std::vector<std::int32_t> surplus_;
    std::vector<std::uint8_t> node_changed_;  ///< [node]
    std::vector<std::uint8_t> leaf_;          ///< [leaf] bits
    std::vector<std::uint32_t> touched_, changed_leaves_, changed_nodes_;
};

}  // namespace alhazen
