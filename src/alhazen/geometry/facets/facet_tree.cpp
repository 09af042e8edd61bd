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
            if (!reject_) {
                counts.polygons += node.count;
                return tree_->pieces(node);
            }
            const std::span<const FacetPiece> piece = next_in(waiting, sides, counts);
            if (piece.empty()) continue;
            return piece;
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

std::span<const FacetPiece> FacetWalk::next_in(const Waiting& waiting, const BeamSides& sides,
                                               FacetWalkCounts& counts) {
    const FacetTree::Node& node = tree_->node(waiting.node);
    const std::span<const FacetPiece> pieces = tree_->pieces(node);
    // The hull of a leaf with one polygon was that polygon, already tested.
    const bool tested =
        pieces.size() == 1 && node.before == FacetTree::kNone && node.behind == FacetTree::kNone;
    for (std::uint32_t k = waiting.from; k < pieces.size(); ++k) {
        if (!tested) {
            ++counts.hulls;
            if (misses(tree_->pool().corners(pieces[k]), sides, tree_->margin())) {
                ++counts.missed;
                continue;
            }
        }
        if (k + 1 < pieces.size()) stack_.push_back({waiting.node, false, k + 1});
        ++counts.polygons;
        return pieces.subspan(k, 1);
    }
    return {};
}

}  // namespace alhazen
