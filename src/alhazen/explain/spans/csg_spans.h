#pragma once
/// The spans of the leaves of a CSG solid along one ray, and their combination by its operators.
///
/// Source: Roth, "Ray Casting for Modeling Solids", CGIP 18, 1982; Foley, van Dam, Feiner and
/// Hughes, "Computer Graphics", 2nd ed., table 15.2 (the classification of each stretch of the ray
/// by the two sides of an operator).
/// Differs: keeps the spans of every node, for display; an operator of many operands is applied
/// pairwise from the first on; crossings closer than the tolerance of CsgSolid are one, at the t of
/// the first.
/// Conventions: t is that of the ray; spans are clipped to [0, infinity).

#include <cstdint>
#include <string>
#include <vector>

#include "alhazen/csg/csg_solid.h"
#include "alhazen/scene_model/scene_description.h"

namespace alhazen {

/// A span of a ray: from < to.
struct TSpan {
    double from = 0, to = 0;
    friend bool operator==(const TSpan&, const TSpan&) = default;
};

/// A leaf or an operator of a solid, and the spans of the ray inside it.
struct CsgSpanNode {
    std::string name;  ///< for a leaf
    bool is_leaf = false;
    Combine combine = Combine::Union;  ///< for an operator
    std::vector<TSpan> spans;
    std::vector<CsgSpanNode> operands;
};

/// The spans of a combination. Arguments and result are ascending and without overlaps.
[[nodiscard]] std::vector<TSpan> combined(Combine combine, const std::vector<TSpan>& left,
                                          const std::vector<TSpan>& right);

/// The spans of all nodes. `ray`: in the frame of the solid. `name_of(primitive)`: name of a leaf.
template <class NameOf>
[[nodiscard]] CsgSpanNode csg_spans(const CsgSolid& solid, const Ray& ray, const NameOf& name_of);

// ---- Details.

[[nodiscard]] std::vector<TSpan> leaf_spans(const CsgSolid& solid, std::uint32_t leaf,
                                            const Ray& ray);
/// Moves ends within `tau` after another to the first of them, in all leaves below `root`.
void close_ranks(CsgSpanNode& root, double tau);
/// Sets the spans of the operators from those of the leaves.
void combine(CsgSpanNode& root);

template <class NameOf>
CsgSpanNode csg_leaves(const CsgSolid& solid, CsgOperand operand, const Ray& ray,
                       const NameOf& name_of) {
    CsgSpanNode node;
    const CsgExpression& expression = solid.expression();
    if (operand.is_leaf()) {
        node.is_leaf = true;
        node.name = name_of(expression.leaves[operand.index()]);
        node.spans = leaf_spans(solid, operand.index(), ray);
        return node;
    }
    const CsgExpression::Node& n = expression.nodes[operand.index()];
    node.combine = n.combine;
    // Recursion is safe: validation bounds the nesting.
    for (const CsgOperand o : n.operands) {
        node.operands.push_back(csg_leaves(solid, o, ray, name_of));
    }
    return node;
}

template <class NameOf>
CsgSpanNode csg_spans(const CsgSolid& solid, const Ray& ray, const NameOf& name_of) {
    CsgSpanNode root = csg_leaves(solid, CsgOperand::node(0), ray, name_of);
    close_ranks(root, solid.prepare(ray).tau);
    combine(root);
    return root;
}

}  // namespace alhazen
