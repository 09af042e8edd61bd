#pragma once
/// A solid as described in the scene: a tree of operators with primitives of a table as leaves.
///
/// Conventions: leaves are numbered in the order of the description; where surfaces of several
/// leaves coincide, that of the lowest-numbered leaf is visible.

#include <cstdint>
#include <vector>

#include "alhazen/geometry/hit.h"
#include "alhazen/scene_model/scene_description.h"

namespace alhazen {

/// An operand of an expression: a leaf or a node.
class CsgOperand {
  public:
    [[nodiscard]] static CsgOperand leaf(std::uint32_t index) { return CsgOperand(~index); }
    [[nodiscard]] static CsgOperand node(std::uint32_t index) { return CsgOperand(index); }
    [[nodiscard]] bool is_leaf() const { return (bits_ & kLeafBit) != 0; }
    [[nodiscard]] std::uint32_t index() const { return is_leaf() ? ~bits_ : bits_; }

  private:
    static constexpr std::uint32_t kLeafBit = 1u << 31;
    explicit CsgOperand(std::uint32_t bits) : bits_(bits) {}
    std::uint32_t bits_;
};

struct CsgExpression {
    struct Node {
        Combine combine = Combine::Union;  ///< never Group
        std::vector<CsgOperand> operands;
    };
    std::vector<Node> nodes;  ///< [0] is the root; operands come after their node
    /// [leaf] true: its surface shows the material of the solid it is subtracted from; empty: false
    /// for all.
    std::vector<bool> shows_minuend;
    std::vector<PrimitiveId> leaves;  ///< [leaf] primitive of the table
    /// [material] true: light enters its volumes; empty: those of all that is not opaque.
    std::vector<bool> clear;
};

/// Numbers of leaves have 31 bits, one of which distinguishes them from nodes.
inline constexpr std::uint32_t kMaxCsgLeaves = (1u << 30) - 1;

}  // namespace alhazen
