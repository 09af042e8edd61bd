#pragma once
/// The tree of operators of a BRL-CAD combination.
///
/// Source: BRL-CAD, "MGED User's Manual", chapter on combinations and regions. Differs: operators
/// have any number of operands: (a u b) u c is one union of three, (a - b) - c one difference, so
/// that the long chains of the files are not deep. Complexity: `combine` O(operands of the smaller
/// side).

#include <cstdint>
#include <string>
#include <vector>

#include "alhazen/math/affine.h"

namespace alhazen {

/// A place in the text of the database.
struct BrlcadPlace {
    int line = 0, column = 0;
};

enum class BrlcadOperator : std::uint8_t { Leaf, Union, Intersection, Difference, ExclusiveOr };

struct BrlcadNode {
    BrlcadOperator op = BrlcadOperator::Leaf;
    std::vector<std::uint32_t> operands;  ///< of Difference: the first without the others
    std::string member;                   ///< of Leaf: the name of what is placed here
    Affine comb_from_member;
    BrlcadPlace place;
};

class BrlcadTree {
  public:
    /// Meaning of `root` in a combination without members.
    static constexpr std::uint32_t kEmpty = ~std::uint32_t{0};

    std::uint32_t add_leaf(std::string member, const Affine& comb_from_member,
                           const BrlcadPlace& place);
    /// The node that joins two others, which then belong to it; either may be kEmpty.
    std::uint32_t combine(BrlcadOperator op, std::uint32_t left, std::uint32_t right);

    [[nodiscard]] const BrlcadNode& node(std::uint32_t index) const { return nodes_[index]; }
    [[nodiscard]] const std::vector<BrlcadNode>& nodes() const { return nodes_; }
    [[nodiscard]] std::uint32_t root() const { return root_; }
    void set_root(std::uint32_t root) { root_ = root; }

  private:
    std::uint32_t join(BrlcadOperator op, std::uint32_t left, std::uint32_t right);

    std::vector<BrlcadNode> nodes_;
    std::uint32_t root_ = kEmpty;
};

/// Puts members that are given one after another, each with the operator in front of it, into a
/// tree: union binds least, the others are taken from left to right. The operator of the first is
/// of no meaning.
class BrlcadMemberList {
  public:
    void add(BrlcadTree& tree, BrlcadOperator op, std::uint32_t leaf);
    /// The root; kEmpty without members. The list is empty then.
    [[nodiscard]] std::uint32_t finish(BrlcadTree& tree);

  private:
    std::uint32_t all_ = BrlcadTree::kEmpty;
    std::uint32_t term_ = BrlcadTree::kEmpty;
};

}  // namespace alhazen
