#include <algorithm>
#include <cmath>

#include "alhazen/geometry/facets/facet_tree.h"
#include "alhazen/geometry/facets/point_hull.h"

namespace alhazen {

namespace {

/// Largest number of polygons that rate a candidate; of more polygons, an even selection does.
constexpr std::size_t kRaters = 384;
/// Least number of polygons for which axis-aligned planes are tried, if candidates leave too many
/// on one side.
constexpr std::size_t kManyOnOneSide = 48;
/// Number of polygons of one plane above which they form a tree of their own.
constexpr std::size_t kManyInPlane = 6;
constexpr std::size_t kHullCorners = 32;
/// Cost of a cut polygon, in polygons out of balance.
constexpr double kSplitCost = 4;

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
    double least_side = 0;  ///< part of the polygons on the smaller side
};

}  // namespace

class FacetTreeBuilder {
  public:
    FacetTreeBuilder(FacetTree& tree, const FacetTreeOptions& options)
        : tree_(tree), options_(options) {}

    void build(std::vector<FacetPiece> polygons) {
        set_margin();
        tree_.report_.polygons = polygons.size();
        add({std::move(polygons), FacetTree::kNone, &FacetTree::Node::before, 1, false});
        while (!waiting_.empty()) {
            const Waiting now = std::move(waiting_.back());
            waiting_.pop_back();
            const auto number = static_cast<std::uint32_t>(tree_.nodes_.size());
            if (now.parent != FacetTree::kNone) tree_.nodes_[now.parent].*now.child = number;
            tree_.report_.depth = std::max(tree_.report_.depth, now.depth);
            tree_.nodes_.emplace_back();
            now.of_one_plane ? halve(now, number) : divide(now, number);
        }
        merge_hulls();
        tree_.report_.nodes = tree_.nodes_.size();
        tree_.report_.pieces = tree_.pieces_.size();
    }

  private:
    /// The polygons of a node that is still to be made.
    struct Waiting {
        std::vector<FacetPiece> polygons;
        std::uint32_t parent;
        std::uint32_t FacetTree::Node::*child;
        std::uint32_t depth;
        bool of_one_plane;
    };
    void add(Waiting waiting) {
        if (!waiting.polygons.empty()) waiting_.push_back(std::move(waiting));
    }

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
        return {plane, (kSplitCost * splits + std::abs(before - behind)) / counted,
                std::min(before, behind) / counted};
    }

    /// Takes an axis-aligned plane through the middle of the polygons if it divides them better.
    void try_free_planes(std::span<const FacetPiece> polygons, PlaneRating& best) const {
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
        }
    }

    [[nodiscard]] PlaneRating choose(std::span<const FacetPiece> polygons) const {
        const std::size_t count =
            std::min<std::size_t>(std::max(options_.candidates, 1u), polygons.size());
        PlaneRating best;
        for (std::size_t k = 0; k < count; ++k) {
            const std::size_t at = (2 * k + 1) * polygons.size() / (2 * count);
            const PlaneRating rating = rate(tree_.pool_.planes[polygons[at].facet], polygons);
            if (k == 0 || rating.cost < best.cost) best = rating;
        }
        if (polygons.size() >= kManyOnOneSide && best.least_side < 0.125) {
            try_free_planes(polygons, best);
        }
        return best;
    }

    void divide(const Waiting& now, std::uint32_t number) {
        const FacetPlane plane = choose(now.polygons).plane;
        std::vector<FacetPiece> in, before, behind;
        for (const FacetPiece& piece : now.polygons) {
            switch (side_of(plane, tree_.margin_, tree_.pool_.corners(piece))) {
                case PlaneSide::In:
                    in.push_back(piece);
                    break;
                case PlaneSide::Before:
                    before.push_back(piece);
                    break;
                case PlaneSide::Behind:
                    behind.push_back(piece);
                    break;
                case PlaneSide::Both:
                    split(plane, piece, before, behind);
                    break;
            }
        }
        if (in.empty() && (before.empty() || behind.empty())) {
            // The polygon lies outside its own plane by rounding: any polygon becomes the node's.
            std::vector<FacetPiece>& rest = before.empty() ? behind : before;
            in.push_back(rest.back());
            rest.pop_back();
        }
        tree_.nodes_[number].plane = plane;
        if (in.size() <= kManyInPlane) {
            keep(in, number);
        } else {
            add({std::move(in), number, &FacetTree::Node::in, now.depth + 1, true});
        }
        add({std::move(before), number, &FacetTree::Node::before, now.depth + 1, false});
        add({std::move(behind), number, &FacetTree::Node::behind, now.depth + 1, false});
    }
    void keep(std::span<const FacetPiece> polygons, std::uint32_t number) {
        tree_.nodes_[number].first = static_cast<std::uint32_t>(tree_.pieces_.size());
        tree_.nodes_[number].count = static_cast<std::uint32_t>(polygons.size());
        tree_.pieces_.insert(tree_.pieces_.end(), polygons.begin(), polygons.end());
    }

    /// Divides polygons of one plane; the order of the halves does not matter.
    void halve(const Waiting& now, std::uint32_t number) {
        if (now.polygons.size() <= kManyInPlane) {
            keep(now.polygons, number);
            return;
        }
        std::vector<FacetPiece> sorted = now.polygons;
        Vec3 lo = tree_.pool_.points[sorted[0].first], hi = lo;
        for (const FacetPiece& piece : sorted) {
            const Vec3& p = tree_.pool_.points[piece.first];
            lo = {std::min(lo.x, p.x), std::min(lo.y, p.y), std::min(lo.z, p.z)};
            hi = {std::max(hi.x, p.x), std::max(hi.y, p.y), std::max(hi.z, p.z)};
        }
        const int axis = dominant_axis(hi - lo);
        const auto half = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
        std::nth_element(sorted.begin(), half, sorted.end(),
                         [&](const FacetPiece& a, const FacetPiece& b) {
                             const double of_a = tree_.pool_.points[a.first][axis];
                             const double of_b = tree_.pool_.points[b.first][axis];
                             return of_a != of_b ? of_a < of_b : a.first < b.first;
                         });
        add({{sorted.begin(), half}, number, &FacetTree::Node::before, now.depth + 1, true});
        add({{half, sorted.end()}, number, &FacetTree::Node::behind, now.depth + 1, true});
    }

    void split(const FacetPlane& plane, const FacetPiece& piece, std::vector<FacetPiece>& before,
               std::vector<FacetPiece>& behind) {
        split_loop(plane, tree_.margin_, tree_.pool_.corners(piece), loop_before_, loop_behind_);
        if (!loop_before_.empty()) before.push_back(tree_.pool_.add(piece.facet, loop_before_));
        if (!loop_behind_.empty()) behind.push_back(tree_.pool_.add(piece.facet, loop_behind_));
        ++tree_.report_.splits;
    }

    /// Merges hulls bottom-up: children have higher numbers than their parents.
    void merge_hulls() {
        std::vector<Vec3> points;
        for (std::size_t n = tree_.nodes_.size(); n-- > 0;) {
            FacetTree::Node& node = tree_.nodes_[n];
            points.clear();
            for (const FacetPiece& piece : tree_.pieces(node)) append(piece, points);
            for (const std::uint32_t child : {node.before, node.behind, node.in}) {
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
        // Reduces the hull in steps, for planes with thousands of polygons.
        const std::span<const Vec3> corners = tree_.pool_.corners(piece);
        points.insert(points.end(), corners.begin(), corners.end());
        if (points.size() > 8 * kHullCorners) reduce_to_hull(points, kHullCorners);
    }

    FacetTree& tree_;
    const FacetTreeOptions& options_;
    std::vector<Waiting> waiting_;
    std::vector<Vec3> loop_before_, loop_behind_;
};

FacetTree::FacetTree(FacetPool pool, std::vector<FacetPiece> polygons,
                     const FacetTreeOptions& options)
    : pool_(std::move(pool)) {
    FacetTreeBuilder(*this, options).build(std::move(polygons));
}

}  // namespace alhazen
