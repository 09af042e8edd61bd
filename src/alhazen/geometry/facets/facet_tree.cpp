#include "alhazen/geometry/facets/facet_tree.h"

namespace alhazen {

bool misses(std::span<const Vec3> points, const BeamSides& sides, double margin) {
    for (const FacetPlane& side : sides) {
        bool outside = true;
        for (const Vec3& p : points) {
            if (side.at(p) >= -margin) {
                outside = false;
                break;
            }
        }
        if (outside) return true;
    }
    return false;
}

std::span<const FacetPiece> FacetWalk::next(const BeamSides& sides, FacetWalkCounts& counts) {
    while (!stack_.empty()) {
        const Waiting waiting = stack_.back();
        stack_.pop_back();
        const FacetTree::Node& node = tree_->node(waiting.node);
        if (!waiting.whole) {
            if (node.in != FacetTree::kNone) {
                stack_.push_back({node.in, true});
                continue;
            }
            counts.polygons += node.count;
            return tree_->pieces(node);
        }
        if (reject_) {
            ++counts.hulls;
            if (misses(tree_->hull(node), sides, tree_->margin())) {
                ++counts.missed;
                continue;
            }
        }
        const bool is_before = apex_.side(node.plane) >= 0.0;
        const std::uint32_t near = is_before ? node.before : node.behind;
        const std::uint32_t far = is_before ? node.behind : node.before;
        if (far != FacetTree::kNone) stack_.push_back({far, true});
        if (node.count > 0 || node.in != FacetTree::kNone) stack_.push_back({waiting.node, false});
        if (near != FacetTree::kNone) stack_.push_back({near, true});
    }
    return {};
}

}  // namespace alhazen
