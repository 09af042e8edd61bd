#include "alhazen/formats/brlcad/brlcad_tree.h"

#include <utility>

namespace alhazen {

std::uint32_t BrlcadTree::add_leaf(std::string member, const Affine& comb_from_member,
                                   const BrlcadPlace& place) {
    BrlcadNode leaf;
    leaf.member = std::move(member);
    leaf.comb_from_member = comb_from_member;
    leaf.place = place;
    nodes_.push_back(std::move(leaf));
    return static_cast<std::uint32_t>(nodes_.size() - 1);
}

std::uint32_t BrlcadTree::add_leaf(std::string member, const std::array<double, 16>& matrix,
                                   const BrlcadPlace& place) {
    const HomogeneousMatrix read(matrix);
    const std::uint32_t leaf = add_leaf(std::move(member), read.transform, place);
    nodes_[leaf].last_row = is_invertible(read.transform) ? read.last_row : LastRow::Perspective;
    return leaf;
}

std::uint32_t BrlcadTree::join(BrlcadOperator op, std::uint32_t left, std::uint32_t right) {
    BrlcadNode node;
    node.op = op;
    node.operands = {left, right};
    node.place = nodes_[left].place;
    nodes_.push_back(std::move(node));
    return static_cast<std::uint32_t>(nodes_.size() - 1);
}

std::uint32_t BrlcadTree::combine(BrlcadOperator op, std::uint32_t left, std::uint32_t right) {
    const bool joins = op == BrlcadOperator::Union || op == BrlcadOperator::ExclusiveOr;
    if (left == kEmpty) return joins ? right : kEmpty;
    if (right == kEmpty) return op == BrlcadOperator::Intersection ? kEmpty : left;
    switch (op) {
        case BrlcadOperator::Union:
        case BrlcadOperator::Intersection: {
            // Both operators are commutative; append to the larger chain. The first operand of an
            // intersection stays first, for regions keep the material of their left operand.
            const std::uint32_t first = nodes_[left].op == op ? nodes_[left].operands[0] : left;
            if (nodes_[left].op != op ||
                (nodes_[right].op == op &&
                 nodes_[right].operands.size() > nodes_[left].operands.size())) {
                std::swap(left, right);
            }
            if (nodes_[left].op != op) return join(op, right, left);
            std::vector<std::uint32_t>& operands = nodes_[left].operands;
            const std::size_t appended = operands.size();
            if (nodes_[right].op == op) {
                const std::vector<std::uint32_t> more = std::exchange(nodes_[right].operands, {});
                operands.insert(operands.end(), more.begin(), more.end());
            } else {
                operands.push_back(right);
            }
            if (operands[0] != first) std::swap(operands[0], operands[appended]);
            return left;
        }
        case BrlcadOperator::Difference:
            if (nodes_[left].op != op) return join(op, left, right);
            nodes_[left].operands.push_back(right);
            return left;
        case BrlcadOperator::ExclusiveOr:
        case BrlcadOperator::Leaf:
            break;
    }
    return join(op, left, right);
}

void BrlcadMemberList::add(BrlcadTree& tree, BrlcadOperator op, std::uint32_t leaf) {
    if (term_ == BrlcadTree::kEmpty || op == BrlcadOperator::Union) {
        all_ = tree.combine(BrlcadOperator::Union, all_, term_);
        term_ = leaf;
    } else {
        term_ = tree.combine(op, term_, leaf);
    }
}

std::uint32_t BrlcadMemberList::finish(BrlcadTree& tree) {
    const std::uint32_t term = std::exchange(term_, BrlcadTree::kEmpty);
    return tree.combine(BrlcadOperator::Union, std::exchange(all_, BrlcadTree::kEmpty), term);
}

}  // namespace alhazen
