#include "alhazen/csg/csg_tree.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "alhazen/math/constants.h"
#include "alhazen/shapes/polygons/polyhedron.h"

namespace alhazen {

namespace {

/// Maximum number of sweeps; further ones hardly shrink the bounds.
constexpr int kMostSweeps = 4;
/// Maximum number of half spaces of an intersection whose corners are computed.
constexpr std::size_t kMostPlanes = 1000;

/// A box around the intersection of half spaces; all space if it is unbounded, empty, or cannot be
/// told from these.
Box3 box_of(std::vector<OrientedPlane> planes) {
    const ConvexCorners solid = convex_corners(planes);
    if (!solid.bounded || !(convex_volume(solid) > 0.0)) return kAllSpace;
    Polyhedron padded;
    padded.planes = std::move(planes);
    padded.prepare();
    Box3 box = padded.bounds;
    for (const Vec3& p : solid.corners) box.include(p);
    return box;
}

/// A box around the part of `box` inside the half spaces.
Box3 clipped(const Box3& box, std::vector<OrientedPlane> planes) {
    if (box.empty() || planes.empty() || planes.size() > kMostPlanes) return box;
    // The finite sides of the box, too.
    const Vec3 near = planes.front().point;
    for (int k = 0; k < 3; ++k) {
        for (const bool high : {false, true}) {
            const double side = high ? box.hi[k] : box.lo[k];
            if (!std::isfinite(side)) continue;
            OrientedPlane plane{near, {0, 0, 0}};
            plane.point[k] = side;
            plane.normal[k] = high ? 1.0 : -1.0;
            planes.push_back(plane);
        }
    }
    return intersection(box, box_of(std::move(planes)));
}

}  // namespace

struct CsgTree::Draft {
    std::vector<bool> is_union;                ///< [node]
    std::vector<std::uint32_t> operand_count;  ///< [node]
};

CsgTree::CsgTree(const CsgExpression& expression, std::span<const Box3> boxes,
                 std::span<const std::optional<OrientedPlane>> planes) {
    Draft draft;
    flatten(expression, draft);
    for (Leaf& leaf : leaves_) {
        leaf.decides = leaf.parent == 0 && draft.is_union.front() != leaf.complement;
        leaf.holds = leaf.parent == 0 && !draft.is_union.front() && !leaf.complement;
    }
    set_needs(draft);
    tighten(draft, boxes, planes);
}

void CsgTree::flatten(const CsgExpression& expression, Draft& draft) {
    leaves_.resize(expression.leaves.size());
    struct Open {
        std::uint32_t node;    ///< in the expression
        std::uint32_t parent;  ///< in the positive form
        bool complement;
    };
    const auto is_union = [&](std::uint32_t node, bool complement) {
        return (expression.nodes[node].combine == Combine::Union) != complement;
    };
    std::vector<Open> open{{0, kNone, false}};
    while (!open.empty()) {
        const Open next = open.back();
        open.pop_back();
        const bool joins = is_union(next.node, next.complement);
        std::uint32_t here = next.parent;
        if (here == kNone || draft.is_union[here] != joins) {
            if (here != kNone) ++draft.operand_count[here];
            nodes_.push_back({here, 0});
            draft.is_union.push_back(joins);
            draft.operand_count.push_back(0);
            here = static_cast<std::uint32_t>(nodes_.size() - 1);
        }
        const CsgExpression::Node& node = expression.nodes[next.node];
        bool first = true;
        for (const CsgOperand operand : node.operands) {
            const bool subtracted = node.combine == Combine::Difference && !first;
            const bool complement = next.complement != subtracted;
            first = false;
            if (operand.is_leaf()) {
                leaves_[operand.index()] = {here, complement, false};
                ++draft.operand_count[here];
            } else {
                open.push_back({operand.index(), here, complement});
            }
        }
    }
}

void CsgTree::set_needs(const Draft& draft) {
    std::vector<std::int32_t> usual(nodes_.size(),
                                    0);  // operands that are true outside of all leaves
    for (const Leaf& leaf : leaves_) usual[leaf.parent] += leaf.complement;
    for (std::size_t i = nodes_.size(); i-- > 0;) {
        const auto threshold =
            draft.is_union[i] ? 1 : static_cast<std::int32_t>(draft.operand_count[i]);
        nodes_[i].need = threshold - usual[i];
        if (nodes_[i].parent != kNone) usual[nodes_[i].parent] += nodes_[i].need <= 0;
    }
}

void CsgTree::tighten(const Draft& draft, std::span<const Box3> boxes,
                      std::span<const std::optional<OrientedPlane>> planes) {
    std::vector<std::vector<OrientedPlane>> planes_of(nodes_.size());
    for (std::size_t i = 0; i < leaves_.size(); ++i) {
        if (!planes[i]) continue;
        const OrientedPlane& plane = *planes[i];
        planes_of[leaves_[i].parent].push_back(
            {plane.point, leaves_[i].complement ? -plane.normal : plane.normal});
    }
    std::vector<Box3> of_node(nodes_.size(), kAllSpace);
    std::vector<Box3> from_below(nodes_.size());
    bounds_.assign(boxes.begin(), boxes.end());
    for (int sweep = 0; sweep < kMostSweeps; ++sweep) {
        // Up: the hull of its operands bounds a union; each operand bounds an intersection.
        for (std::size_t i = 0; i < nodes_.size(); ++i) {
            from_below[i] = draft.is_union[i] ? Box3{} : kAllSpace;
        }
        const auto add = [&](std::uint32_t node, const Box3& box) {
            if (draft.is_union[node]) {
                from_below[node].include(box);
            } else {
                from_below[node] = intersection(from_below[node], box);
            }
        };
        for (std::size_t i = 0; i < leaves_.size(); ++i) {
            add(leaves_[i].parent, leaves_[i].complement ? kAllSpace : bounds_[i]);
        }
        for (std::size_t i = nodes_.size(); i-- > 0;) {
            if (sweep == 0 && !draft.is_union[i] && !from_below[i].bounded()) {
                from_below[i] = clipped(from_below[i], std::move(planes_of[i]));
            }
            of_node[i] = intersection(of_node[i], from_below[i]);
            if (nodes_[i].parent != kNone) add(nodes_[i].parent, of_node[i]);
        }
        // Down: an operand matters only inside its parent's bound.
        bool shrunk = false;
        for (std::size_t i = 1; i < nodes_.size(); ++i) {
            of_node[i] = intersection(of_node[i], of_node[nodes_[i].parent]);
        }
        for (std::size_t i = 0; i < leaves_.size(); ++i) {
            const Box3 bound = intersection(bounds_[i], of_node[leaves_[i].parent]);
            shrunk |= bound != bounds_[i];
            bounds_[i] = bound;
        }
        if (!shrunk) break;
    }
    box_ = of_node.front();
}

std::size_t CsgTree::memory_bytes() const {
    return nodes_.capacity() * sizeof(Node) + leaves_.capacity() * sizeof(Leaf) +
           bounds_.capacity() * sizeof(Box3);
}

}  // namespace alhazen
