#include <algorithm>
#include <cmath>

#include "alhazen/geometry/facets/facet_tree.h"
#include "alhazen/geometry/facets/point_hull.h"

namespace alhazen {

namespace {

/// Polygons that rate a candidate; of more, as many evenly spread ones do.
constexpr std::size_t kRaters = 384;
/// So many are divided by a plane across an axis where candidates leave too many on one side.
constexpr std::size_t kManyOnOneSide = 48;
constexpr std::size_t kHullCorners = 32;

enum class PlaneSide : std::uint8_t { In, Before, Behind, Both };

PlaneSide side_of(const FacetPlane& plane, double margin, std::span<const Vec3> corners) {
    const SideRange range = side_range(plane, corners);
    const bool before = range.most > margin, behind = range.least < -margin;
    if (before) return behind ? PlaneSide::Both : PlaneSide::Before;
    return behind ? PlaneSide::Behind : PlaneSide::In;
}

struct PlaneRating {
    FacetPlane plane;
    double cost = 0;
    double least_side = 0;  ///< share of the polygons
};

}  // namespace

class FacetTreeBuilder {
  public:
    FacetTreeBuilder(FacetTree& tree, const FacetTreeOptions& options)
        : tree_(tree), options_(options) {}

    void build(std::vector<FacetPiece> polygons) {
        set_margin();
        tree_.report_.polygons = polygons.size();
        struct Waiting {
            std::vector<FacetPiece> polygons;
            std::uint32_t parent;
            bool before;
            std::uint32_t depth;
        };
        std::vector<Waiting> waiting;
        waiting.push_back({std::move(polygons), FacetTree::kNone, false, 1});
        while (!waiting.empty()) {
            Waiting now = std::move(waiting.back());
            waiting.pop_back();
            if (now.polygons.empty()) continue;
            const auto number = static_cast<std::uint32_t>(tree_.nodes_.size());
            if (now.parent != FacetTree::kNone) {
                FacetTree::Node& parent = tree_.nodes_[now.parent];
                (now.before ? parent.before : parent.behind) = number;
            }
            tree_.report_.depth = std::max(tree_.report_.depth, now.depth);
            std::vector<FacetPiece> before, behind;
            divide(now.polygons, before, behind);
            waiting.push_back({std::move(before), number, true, now.depth + 1});
            waiting.push_back({std::move(behind), number, false, now.depth + 1});
        }
        merge_hulls();
        tree_.report_.nodes = tree_.nodes_.size();
        tree_.report_.pieces = tree_.pieces_.size();
        tree_.report_.hull_corners = tree_.hull_points_.size();
    }

  private:
    void set_margin() {
        double size = 0.0;
        for (const Vec3& p : tree_.pool_.points) size = std::fmax(size, max_component(abs(p)));
        tree_.margin_ = 0x1p-38 * size;
    }

    [[nodiscard]] PlaneRating rate(const FacetPlane& plane,
                                   std::span<const FacetPiece> polygons) const {
        const std::size_t step = std::max<std::size_t>(1, polygons.size() / kRaters);
        double counted = 0.0, splits = 0.0, before = 0.0, behind = 0.0;
        for (std::size_t k = 0; k < polygons.size(); k += step) {
            const PlaneSide side = side_of(plane, tree_.margin_, tree_.pool_.corners(polygons[k]));
            counted += 1.0;
            splits += side == PlaneSide::Both;
            before += side == PlaneSide::Before || side == PlaneSide::Both;
            behind += side == PlaneSide::Behind || side == PlaneSide::Both;
        }
        return {plane, (options_.split_cost * splits + std::abs(before - behind)) / counted,
                std::min(before, behind) / counted};
    }

    /// The plane across the longest axes at the middle of the polygons, if it divides them better.
    [[nodiscard]] bool try_free_planes(std::span<const FacetPiece> polygons,
                                       PlaneRating& best) const {
        bool found = false;
        std::vector<double> middles;
        for (int axis = 0; axis < 3; ++axis) {
            middles.clear();
            for (const FacetPiece& p : polygons) {
                middles.push_back(tree_.pool_.points[p.first][axis]);
            }
            const auto half = middles.begin() + static_cast<std::ptrdiff_t>(middles.size() / 2);
            std::nth_element(middles.begin(), half, middles.end());
            FacetPlane plane;
            plane.normal[axis] = 1.0;
            plane.offset = *half;
            const PlaneRating rating = rate(plane, polygons);
            if (rating.cost >= best.cost || rating.least_side <= best.least_side) continue;
            best = rating;
            found = true;
        }
        return found;
    }

    [[nodiscard]] PlaneRating choose(std::span<const FacetPiece> polygons) {
        const std::size_t count =
            std::min<std::size_t>(std::max(options_.candidates, 1u), polygons.size());
        PlaneRating best;
        for (std::size_t k = 0; k < count; ++k) {
            const std::size_t at = (2 * k + 1) * polygons.size() / (2 * count);
            const PlaneRating rating = rate(tree_.pool_.planes[polygons[at].facet], polygons);
            if (k == 0 || rating.cost < best.cost) best = rating;
        }
        if (polygons.size() >= kManyOnOneSide && best.least_side < 0.125) {
            tree_.report_.free_planes += try_free_planes(polygons, best);
        }
        return best;
    }

    void divide(std::span<const FacetPiece> polygons, std::vector<FacetPiece>& before,
                std::vector<FacetPiece>& behind) {
        FacetTree::Node node;
        node.plane = choose(polygons).plane;
        node.first = static_cast<std::uint32_t>(tree_.pieces_.size());
        for (const FacetPiece& piece : polygons) {
            switch (side_of(node.plane, tree_.margin_, tree_.pool_.corners(piece))) {
                case PlaneSide::In:
                    tree_.pieces_.push_back(piece);
                    break;
                case PlaneSide::Before:
                    before.push_back(piece);
                    break;
                case PlaneSide::Behind:
                    behind.push_back(piece);
                    break;
                case PlaneSide::Both:
                    split(node.plane, piece, before, behind);
                    break;
            }
        }
        node.count = static_cast<std::uint32_t>(tree_.pieces_.size()) - node.first;
        if (node.count == 0 && (before.empty() || behind.empty())) {
            // A plane of rounding alone: its polygon is the node.
            std::vector<FacetPiece>& rest = before.empty() ? behind : before;
            tree_.pieces_.push_back(rest.back());
            rest.pop_back();
            node.count = 1;
        }
        tree_.nodes_.push_back(node);
    }

    void split(const FacetPlane& plane, const FacetPiece& piece, std::vector<FacetPiece>& before,
               std::vector<FacetPiece>& behind) {
        split_loop(plane, tree_.margin_, tree_.pool_.corners(piece), loop_before_, loop_behind_);
        if (!loop_before_.empty()) before.push_back(tree_.pool_.add(piece.facet, loop_before_));
        if (!loop_behind_.empty()) behind.push_back(tree_.pool_.add(piece.facet, loop_behind_));
        ++tree_.report_.splits;
    }

    /// Children have higher numbers than their parents.
    void merge_hulls() {
        std::vector<Vec3> points;
        for (std::size_t n = tree_.nodes_.size(); n-- > 0;) {
            FacetTree::Node& node = tree_.nodes_[n];
            points.clear();
            for (const FacetPiece& piece : tree_.pieces(node)) append(piece, points);
            for (const std::uint32_t child : {node.before, node.behind}) {
                if (child == FacetTree::kNone) continue;
                const std::span<const Vec3> hull = tree_.hull(tree_.nodes_[child]);
                points.insert(points.end(), hull.begin(), hull.end());
            }
            reduce_to_hull(points, kHullCorners);
            node.first_corner = static_cast<std::uint32_t>(tree_.hull_points_.size());
            node.corners = static_cast<std::uint32_t>(points.size());
            tree_.hull_points_.insert(tree_.hull_points_.end(), points.begin(), points.end());
        }
    }
    void append(const FacetPiece& piece, std::vector<Vec3>& points) const {
        // Of a plane with thousands of polygons the hull is taken in steps.
        const std::span<const Vec3> corners = tree_.pool_.corners(piece);
        points.insert(points.end(), corners.begin(), corners.end());
        if (points.size() > 8 * kHullCorners) reduce_to_hull(points, kHullCorners);
    }

    FacetTree& tree_;
    const FacetTreeOptions& options_;
    std::vector<Vec3> loop_before_, loop_behind_;
};

FacetTree::FacetTree(FacetPool pool, std::vector<FacetPiece> polygons,
                     const FacetTreeOptions& options)
    : pool_(std::move(pool)) {
    FacetTreeBuilder(*this, options).build(std::move(polygons));
}

}  // namespace alhazen
