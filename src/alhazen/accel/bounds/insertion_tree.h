#pragma once
/// The mutable hierarchy of Goldsmith and Salmon's insertion: nodes with any number of children,
/// linked both ways.
///
/// Source: Goldsmith and Salmon, "Automatic Creation of Object Hierarchies for Ray Tracing", IEEE
/// CG&A 7(5), 1987; the increments of the cost as given by Haines.
/// Differs: a node has at most 64 children.
/// Conventions: the cost is the sum of k A over the inner nodes: the cost of the source times the
/// area of the root, without the root's own test.

#include <cstdint>
#include <vector>

#include "alhazen/accel/bounds/bound_tree.h"

namespace alhazen {

class InsertionTree {
  public:
    explicit InsertionTree(std::size_t primitives);

    /// Inserts a primitive where the cost grows least; returns the growth.
    double insert(std::uint32_t primitive, const BoxBound& bound);
    /// Removes a primitive. Precondition: it is in the tree.
    void remove(std::uint32_t primitive);

    /// The sum of k A, recomputed.
    [[nodiscard]] double cost() const;
    [[nodiscard]] BoundTree<BoxBound> flattened() const;
    /// Number of nodes examined by all insertions.
    [[nodiscard]] std::uint64_t nodes_looked_at() const { return looked_at_; }

  private:
    static constexpr std::uint32_t kNone = 0xFFFFFFFFu;
    /// Limits the children of coincident boxes, whose cost is the same for any number of children.
    static constexpr std::size_t kMostChildren = 64;
    struct Node {
        BoxBound bound;
        std::uint32_t parent = kNone;
        std::uint32_t primitive = kNone;  ///< primitive of a leaf
        std::uint32_t leaves = 1;         ///< primitives below
        std::vector<std::uint32_t> children;
    };
    struct Place {
        std::uint32_t node = kNone;
        bool as_child = false;  ///< else as its sibling, under a new parent
        double increase = std::numeric_limits<double>::infinity();
    };

    [[nodiscard]] Place best_place(const BoxBound& bound);
    [[nodiscard]] std::uint32_t child_to_descend(const Node& node, const BoxBound& bound) const;
    [[nodiscard]] std::uint32_t new_node();
    void put_beside(std::uint32_t node, std::uint32_t leaf);
    void grow_upward(std::uint32_t node, const BoxBound& bound);
    void shrink_upward(std::uint32_t node);
    void replace_child(std::uint32_t parent, std::uint32_t old_child, std::uint32_t new_child);

    std::vector<Node> nodes_;
    std::vector<std::uint32_t> free_;     ///< nodes not in use
    std::vector<std::uint32_t> leaf_of_;  ///< [primitive]
    std::uint32_t root_ = kNone;
    std::uint64_t looked_at_ = 0;
};

/// Half the surface area plus a small multiple of the squared edges, so that flat boxes can be
/// compared.
[[nodiscard]] double insertion_area(const BoxBound& bound);

}  // namespace alhazen
