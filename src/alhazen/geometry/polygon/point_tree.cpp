#include "alhazen/geometry/polygon/point_tree.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "alhazen/math/orientation.h"

namespace alhazen {

namespace {

constexpr std::size_t kLeafSize = 8;

/// True if all points of the box are certainly to the right of the line from a to b.
bool is_right_of(Vec2 lo, Vec2 hi, Vec2 a, Vec2 b) {
    const Vec2 d = b - a;
    // The corner of the box farthest to the left.
    const double up = d.x * ((d.x >= 0.0 ? hi.y : lo.y) - a.y);
    const double across = d.y * ((d.y >= 0.0 ? lo.x : hi.x) - a.x);
    return up - across < -1e-15 * (std::abs(up) + std::abs(across));
}

}  // namespace

struct PointTree::Query {
    std::array<Vec2, 3> corner;
    Vec2 lo, hi;
    bool has_area = true;

    Query(Vec2 a, Vec2 b, Vec2 c) : corner{a, b, c}, has_area(orientation(a, b, c) != 0) {
        lo = {std::min({a.x, b.x, c.x}), std::min({a.y, b.y, c.y})};
        hi = {std::max({a.x, b.x, c.x}), std::max({a.y, b.y, c.y})};
    }
    [[nodiscard]] bool misses(const Node& node) const {
        // A triangle without area stands for its whole line.
        if (has_area &&
            (node.hi.x < lo.x || hi.x < node.lo.x || node.hi.y < lo.y || hi.y < node.lo.y)) {
            return true;
        }
        return is_right_of(node.lo, node.hi, corner[0], corner[1]) ||
               is_right_of(node.lo, node.hi, corner[1], corner[2]) ||
               is_right_of(node.lo, node.hi, corner[2], corner[0]);
    }
    [[nodiscard]] bool holds(Vec2 p) const {
        if (p == corner[0] || p == corner[1] || p == corner[2]) return false;
        return orientation(corner[0], corner[1], p) >= 0 &&
               orientation(corner[1], corner[2], p) >= 0 &&
               orientation(corner[2], corner[0], p) >= 0;
    }
};

PointTree::PointTree(const std::vector<Vec2>& points, std::vector<std::uint32_t> ids)
    : points_(points),
      ids_(std::move(ids)),
      active_(ids_.size()),
      place_of_(points.size()),
      leaf_count_(std::bit_ceil((ids_.size() + kLeafSize - 1) / kLeafSize)) {
    nodes_.resize(2 * leaf_count_);
    build(1, 0, leaf_count_);
    for (std::size_t i = 0; i < ids_.size(); ++i) place_of_[ids_[i]] = std::uint32_t(i);
}

/// The recursion depth is the depth of the tree: log2 of the number of leaves.
void PointTree::build(std::size_t node, std::size_t first_leaf, std::size_t leaves) {
    constexpr double kNone = std::numeric_limits<double>::infinity();
    const std::size_t begin = std::min(ids_.size(), first_leaf * kLeafSize);
    const std::size_t end = std::min(ids_.size(), (first_leaf + leaves) * kLeafSize);
    Vec2 lo{kNone, kNone};
    Vec2 hi{-kNone, -kNone};
    for (std::size_t i = begin; i < end; ++i) {
        const Vec2 p = points_[ids_[i]];
        lo = {std::min(lo.x, p.x), std::min(lo.y, p.y)};
        hi = {std::max(hi.x, p.x), std::max(hi.y, p.y)};
    }
    nodes_[node] = {lo, hi, 0};
    if (leaves == 1) return;
    const std::size_t middle = (first_leaf + leaves / 2) * kLeafSize;
    if (middle < end) {
        const bool by_x = hi.x - lo.x >= hi.y - lo.y;
        const auto less = [&](std::uint32_t i, std::uint32_t j) {
            return by_x ? points_[i].x < points_[j].x : points_[i].y < points_[j].y;
        };
        const auto at = [&](std::size_t i) { return ids_.begin() + std::ptrdiff_t(i); };
        std::nth_element(at(begin), at(middle), at(end), less);
    }
    build(2 * node, first_leaf, leaves / 2);
    build(2 * node + 1, first_leaf + leaves / 2, leaves / 2);
}

void PointTree::activate(std::uint32_t id, bool active) {
    const std::size_t place = place_of_[id];
    if (active_[place] == active) return;
    active_[place] = active;
    for (std::size_t node = leaf_count_ + place / kLeafSize; node > 0; node /= 2) {
        active ? ++nodes_[node].active : --nodes_[node].active;
    }
}

bool PointTree::any_in_leaf(const Query& query, std::size_t leaf) const {
    const std::size_t begin = leaf * kLeafSize;
    const std::size_t end = std::min(ids_.size(), begin + kLeafSize);
    for (std::size_t i = begin; i < end; ++i) {
        if (active_[i] && query.holds(points_[ids_[i]])) return true;
    }
    tests_ += kLeafSize;
    return false;
}

bool PointTree::any_in(Vec2 a, Vec2 b, Vec2 c) const {
    const Query query(a, b, c);
    std::array<std::size_t, 64> waiting{1};
    std::size_t count = 1;
    while (count > 0) {
        const std::size_t node = waiting[--count];
        ++tests_;
        if (nodes_[node].active == 0 || query.misses(nodes_[node])) continue;
        if (node >= leaf_count_) {
            if (any_in_leaf(query, node - leaf_count_)) return true;
            continue;
        }
        waiting[count++] = 2 * node;
        waiting[count++] = 2 * node + 1;
    }
    return false;
}

}  // namespace alhazen
