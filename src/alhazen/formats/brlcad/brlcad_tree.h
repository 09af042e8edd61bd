#pragma once
/// Operator tree of a BRL-CAD combination.
///
/// Source: BRL-CAD, "MGED User's Manual", chapter on combinations and regions.
/// Differs: operators are n-ary: (a u b) u c is one union of three, (a - b) - c one difference, so
/// that long chains stay shallow.
/// Complexity: `combine` O(operands of the smaller side).

#include <cstdint>
#include <string>
#include <vector>

#include "alhazen/formats/core/homogeneous_matrix.h"

namespace alhazen {

/// A position in the text of the database.
struct BrlcadPlace {
    int line = 0, column = 0;
};

enum class BrlcadOperator : std::uint8_t { Leaf, Union, Intersection, Difference, ExclusiveOr };

struct BrlcadNode {
    BrlcadOperator op = BrlcadOperator::Leaf;
    std::vector<std::uint32_t> operands;  ///< of Difference: the first minus the others
    std::string member;                   ///< of Leaf: the name of the placed object
    Affine comb_from_member;
    LastRow last_row = LastRow::Exact;  ///< of the matrix; Perspective: the member has no transform
    BrlcadPlace place;
};

class BrlcadTree {
  public:
    /// Value of `root` for a combination without members.
    static constexpr std::uint32_t kEmpty = ~std::uint32_t{0};

    std::uint32_t add_leaf(std::string member, const Affine& comb_from_member,
                           const BrlcadPlace& place);
    /// Adds a leaf with the matrix of the file. A matrix without an inverse gives no transform.
    std::uint32_t add_leaf(std::string member, const std::array<double, 16>& matrix,
                           const BrlcadPlace& place);
    /// Joins two nodes under an operator, which takes ownership of them. Either may be kEmpty.
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

/// Builds a tree from a sequence of members, each with its operator in front. Union binds weakest;
/// the other operators associate to the left. The operator of the first member is ignored.
class BrlcadMemberList {
  public:
    void add(BrlcadTree& tree, BrlcadOperator op, std::uint32_t leaf);
    /// Returns the root (kEmpty without members) and clears the list.
    [[nodiscard]] std::uint32_t finish(BrlcadTree& tree);

  private:
    std::uint32_t all_ = BrlcadTree::kEmpty;
    std::uint32_t term_ = BrlcadTree::kEmpty;
};

}  // namespace alhazen
