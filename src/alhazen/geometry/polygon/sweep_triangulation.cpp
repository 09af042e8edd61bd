#include "alhazen/geometry/polygon/sweep_triangulation.h"

#include <algorithm>
#include <iterator>
#include <set>
#include <utility>

#include "alhazen/math/orientation.h"

namespace alhazen {

namespace {

constexpr std::uint32_t kNone = 0xFFFFFFFFu;

/// The order of the sweep: by x, then by y.
bool is_before(Vec2 a, Vec2 b) {
    return a.x != b.x ? a.x < b.x : a.y < b.y;
}

class Sweep {
  public:
    /// `loop`: the vertex indices; neighbours do not coincide.
    Sweep(const std::vector<Vec2>& flat, const std::vector<std::uint32_t>& loop,
          std::vector<std::array<std::uint32_t, 3>>& triangles)
        : loop_(loop),
          triangles_(triangles),
          region_of_(loop.size(), kNone),
          lower_edges_(IsBelow{this}) {
        points_.reserve(loop.size());
        for (const std::uint32_t i : loop) points_.push_back(flat[i]);
        nodes_.reserve(loop.size() + loop.size() / 2);
    }

    /// False if the sweep does not end as it does for a simple polygon.
    bool run() {
        std::vector<std::uint32_t> order(loop_.size());
        for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = i;
        std::sort(order.begin(), order.end(), [&](std::uint32_t i, std::uint32_t j) {
            return points_[i] == points_[j] ? i < j : is_before(points_[i], points_[j]);
        });
        return std::all_of(order.begin(), order.end(), [&](std::uint32_t v) { return visit(v); }) &&
               lower_edges_.empty();
    }

  private:
    /// A vertex of a chain, with its neighbours in the chain.
    struct Node {
        std::uint32_t vertex = 0, below = kNone, above = kNone;
    };
    /// An open region at the sweep line between two edges, named by their first vertices in the
    /// loop. Its chain runs from the left end of the lower edge to that of the upper edge.
    struct Region {
        std::uint32_t lower = 0, upper = 0;
        std::uint32_t lowest = 0, highest = 0, rightmost = 0;  ///< nodes of the chain
    };
    struct IsBelow {
        using is_transparent = void;
        const Sweep* sweep;
        /// Compares two edges that do not cross.
        bool operator()(std::uint32_t a, std::uint32_t b) const {
            const auto [a_left, a_right] = sweep->lower_edge(a);
            const auto [b_left, b_right] = sweep->lower_edge(b);
            if (is_before(a_left, b_left)) return orientation(a_left, a_right, b_left) > 0;
            if (is_before(b_left, a_left)) return orientation(b_left, b_right, a_left) < 0;
            return orientation(a_left, a_right, b_right) > 0;
        }
        bool operator()(std::uint32_t a, Vec2 p) const {
            const auto [left, right] = sweep->lower_edge(a);
            return orientation(left, right, p) > 0;
        }
        bool operator()(Vec2 p, std::uint32_t a) const {
            const auto [left, right] = sweep->lower_edge(a);
            return orientation(left, right, p) < 0;
        }
    };

    [[nodiscard]] std::uint32_t previous(std::uint32_t i) const {
        return i == 0 ? std::uint32_t(points_.size() - 1) : i - 1;
    }
    [[nodiscard]] std::uint32_t next(std::uint32_t i) const {
        return i + 1 == points_.size() ? 0 : i + 1;
    }
    /// The interior lies to the left of an edge: lower edges run to the right.
    [[nodiscard]] std::pair<Vec2, Vec2> lower_edge(std::uint32_t region) const {
        const std::uint32_t edge = regions_[region].lower;
        return {points_[edge], points_[next(edge)]};
    }

    bool visit(std::uint32_t v) {
        const std::uint32_t in =
            previous(v);  // the edge that ends at v; the edge that starts there is v
        const Vec2 p = points_[v];
        const bool from_left = is_before(points_[in], p);
        const bool to_left = is_before(points_[next(v)], p);
        if (from_left != to_left) return from_left ? follow_lower(v, in) : follow_upper(v, in);
        const int turn = orientation(points_[in], p, points_[next(v)]);
        if (turn == 0) return false;
        if (from_left) return turn > 0 ? finish(v, in) : merge(v, in);
        return turn > 0 ? start(v, in) : split(v, in);
    }

    bool follow_lower(std::uint32_t v, std::uint32_t in) {
        const std::uint32_t region = region_of_[in];
        if (region == kNone) return false;
        // The order in the set is unchanged: the new edge begins where the old one ends.
        regions_[region].lower = v;
        region_of_[v] = region;
        add_below(regions_[region], v);
        return true;
    }
    bool follow_upper(std::uint32_t v, std::uint32_t in) {
        const std::uint32_t region = region_of_[v];
        if (region == kNone) return false;
        regions_[region].upper = in;
        region_of_[in] = region;
        add_above(regions_[region], v);
        return true;
    }
    bool start(std::uint32_t v, std::uint32_t in) {
        const std::uint32_t node = new_node(v);
        return open({.lower = v, .upper = in, .lowest = node, .highest = node, .rightmost = node});
    }
    /// Splits a chain in two: v sees the rightmost vertex of the chain around it.
    bool split(std::uint32_t v, std::uint32_t in) {
        auto above = lower_edges_.lower_bound(points_[v]);
        if (above == lower_edges_.begin()) return false;
        const std::uint32_t around = *std::prev(above);
        Region upper = regions_[around];
        const std::uint32_t seen = regions_[around].rightmost;
        upper.lower = v;
        upper.lowest = new_node(nodes_[seen].vertex);
        link(upper.lowest, nodes_[seen].above);
        if (upper.highest == seen) upper.highest = upper.lowest;
        add_below(upper, v);
        Region& lower = regions_[around];
        lower.upper = in;
        lower.highest = seen;
        nodes_[seen].above = kNone;
        region_of_[in] = around;
        add_above(lower, v);
        return open(upper);
    }
    bool merge(std::uint32_t v, std::uint32_t in) {
        const std::uint32_t below = region_of_[v], above = region_of_[in];
        if (below == kNone || above == kNone || below == above) return false;
        Region& lower = regions_[below];
        Region& upper = regions_[above];
        add_above(lower, v);
        add_below(upper, v);
        // Both chains end at v: merges the two nodes.
        const std::uint32_t second = nodes_[upper.lowest].above;
        link(lower.highest, second);
        lower.highest = upper.highest;
        lower.upper = upper.upper;
        region_of_[lower.upper] = below;
        return close(above);
    }
    bool finish(std::uint32_t v, std::uint32_t in) {
        const std::uint32_t region = region_of_[in];
        if (region == kNone || region != region_of_[v]) return false;
        Region& last = regions_[region];
        add_below(last, v);
        add_above(last, v);
        // v, a, v: all other vertices are cut off.
        const std::uint32_t middle = nodes_[last.lowest].above;
        return nodes_[middle].above == last.highest && close(region);
    }

    bool open(const Region& region) {
        const std::uint32_t number = std::uint32_t(regions_.size());
        regions_.push_back(region);
        region_of_[region.lower] = region_of_[region.upper] = number;
        const auto [place, is_new] = lower_edges_.insert(number);
        places_.push_back(place);
        return is_new;
    }
    bool close(std::uint32_t region) {
        lower_edges_.erase(std::exchange(places_[region], lower_edges_.end()));
        region_of_[regions_[region].lower] = kNone;
        return true;
    }
    std::uint32_t new_node(std::uint32_t vertex) {
        nodes_.push_back({vertex});
        return std::uint32_t(nodes_.size() - 1);
    }
    void link(std::uint32_t below, std::uint32_t above) {
        nodes_[below].above = above;
        if (above != kNone) nodes_[above].below = below;
    }

    /// Makes v the lower end of a chain and cuts off the vertices it sees.
    void add_below(Region& region, std::uint32_t v) {
        std::uint32_t first = region.lowest;
        std::uint32_t second = nodes_[first].above;
        while (second != kNone && cut(nodes_[second].vertex, nodes_[first].vertex, v)) {
            first = second;
            second = nodes_[second].above;
        }
        const std::uint32_t node = new_node(v);
        link(node, first);
        region.lowest = region.rightmost = node;
    }
    void add_above(Region& region, std::uint32_t v) {
        std::uint32_t first = region.highest;
        std::uint32_t second = nodes_[first].below;
        while (second != kNone && cut(v, nodes_[first].vertex, nodes_[second].vertex)) {
            first = second;
            second = nodes_[second].below;
        }
        const std::uint32_t node = new_node(v);
        link(first, node);
        region.highest = region.rightmost = node;
    }
    /// Emits the triangle if it turns left.
    bool cut(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        if (orientation(points_[a], points_[b], points_[c]) <= 0) return false;
        triangles_.push_back({loop_[a], loop_[b], loop_[c]});
        return true;
    }

    const std::vector<std::uint32_t>& loop_;
    std::vector<std::array<std::uint32_t, 3>>& triangles_;
    std::vector<Vec2> points_;              ///< [index in loop_]
    std::vector<std::uint32_t> region_of_;  ///< [edge that crosses the sweep line]
    std::vector<Region> regions_;
    std::vector<Node> nodes_;
    std::set<std::uint32_t, IsBelow> lower_edges_;                    ///< regions, the lowest first
    std::vector<std::set<std::uint32_t, IsBelow>::iterator> places_;  ///< [region]
};

}  // namespace

std::optional<std::vector<std::array<std::uint32_t, 3>>> triangulate_by_sweep(
    const std::vector<Vec2>& flat) {
    std::vector<std::array<std::uint32_t, 3>> triangles;
    triangles.reserve(flat.size() - 2);
    std::vector<std::uint32_t> loop;
    loop.reserve(flat.size());
    for (std::uint32_t i = 0; i < flat.size(); ++i) {
        const std::uint32_t next = i + 1 == flat.size() ? 0 : i + 1;
        if (flat[i] != flat[next]) loop.push_back(i);
    }
    if (loop.size() < 3) return std::nullopt;
    // Triangles of the vertices left out of the loop, each from its last kept predecessor.
    for (std::size_t k = 0; k < loop.size(); ++k) {
        const std::uint32_t before = loop[k == 0 ? loop.size() - 1 : k - 1];
        const std::uint32_t n = std::uint32_t(flat.size());
        for (std::uint32_t i = (before + 1) % n; i != loop[k]; i = (i + 1) % n) {
            triangles.push_back({before, i, (i + 1) % n});
        }
    }
    if (!Sweep(flat, loop, triangles).run() || triangles.size() != flat.size() - 2) {
        return std::nullopt;
    }
    return triangles;
}

}  // namespace alhazen
