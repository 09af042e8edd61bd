#pragma once
/// Four traversals of the leaves of an octree. All visit the same leaves in the same order, except
/// for leaves that a ray only touches.
///
/// Source: Glassner, "Space Subdivision for Fast Ray Tracing", IEEE CG&A 4(10), 1984
/// (`PointLocation`); Samet, "Implementing Ray Tracing with Octrees and Neighbor Finding",
/// Computers & Graphics 13(4), 1989 (`NeighborFinding`); Spackman and Willis, "The SMART Navigation
/// of a Ray Through an Oct-tree", Computers & Graphics 15(2), 1991 (`Smart`); Revelles, Urena and
/// Lastra, "An Efficient Parametric Algorithm for Octree Traversal", WSCG 2000 (`Parametric`).
/// Differs: the first three compute the next cell's position along the crossed axis in integers, so
/// a point just beyond a face never falls back; the fourth recomputes the middle planes instead of
/// halving t, so that directions with zeros need no special case.
/// Conventions: `walk(visit)` calls visit(leaf, exit t) in order until it returns true.
/// `stats.nodes` counts every examined node, including inner ones.

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "alhazen/accel/cells/octree_cells.h"
#include "alhazen/math/constants.h"

namespace alhazen {

/// A ray in an octree: its entry, and its crossings with planes.
class OctreeRay {
  public:
    OctreeRay(const OctreeCells& cells, const Ray& ray, double t_max)
        : cells_(cells), ray_(ray), span_(cells.box(), ray, t_max) {
        for (int k = 0; k < 3; ++k) moves_[k] = !std::isinf(span_.inverse[k]);
    }

    [[nodiscard]] bool misses() const { return span_.empty(); }
    [[nodiscard]] double enter() const { return span_.begin; }
    [[nodiscard]] bool moves(int axis) const { return moves_[axis]; }
    [[nodiscard]] bool upward(int axis) const { return ray_.direction[axis] > 0.0; }
    [[nodiscard]] double origin(int axis) const { return ray_.origin[axis]; }
    /// The t at which the ray crosses a plane; infinite if parallel to it.
    [[nodiscard]] double at_plane(int axis, std::int32_t unit) const {
        if (!moves_[axis]) return std::numeric_limits<double>::infinity();
        return (cells_.plane(axis, unit) - ray_.origin[axis]) * span_.inverse[axis];
    }
    /// The axis across which the ray leaves a cell, and its t there.
    struct Exit {
        int axis;
        double t;
    };
    [[nodiscard]] Exit exit_of(const OctreeCells::Node& cell) const {
        Exit exit{0, std::numeric_limits<double>::infinity()};
        for (int k = 0; k < 3; ++k) {
            const std::int32_t from = cell.origin[static_cast<std::size_t>(k)];
            const double t = at_plane(k, upward(k) ? from + cells_.span(cell) : from);
            if (t < exit.t) exit = {k, t};
        }
        return exit;
    }
    /// The unit at t, clamped to a cell.
    [[nodiscard]] OctreeCells::Units units_at(double t, const OctreeCells::Node& cell) const {
        OctreeCells::Units at;
        for (int k = 0; k < 3; ++k) {
            const auto a = static_cast<std::size_t>(k);
            const double x = ray_.origin[k] + (moves_[k] ? t * ray_.direction[k] : 0.0);
            at[a] = cells_.unit(k, x, cell.origin[a], cell.origin[a] + cells_.span(cell) - 1);
        }
        return at;
    }
    /// The unit just beyond the face of a cell; false outside the root.
    [[nodiscard]] bool units_beyond(const Exit& exit, const OctreeCells::Node& cell,
                                    OctreeCells::Units& at) const {
        if (std::isinf(exit.t)) return false;
        at = units_at(exit.t, cell);
        const auto a = static_cast<std::size_t>(exit.axis);
        at[a] = upward(exit.axis) ? cell.origin[a] + cells_.span(cell) : cell.origin[a] - 1;
        return at[a] >= 0 && at[a] < std::int32_t{1} << cells_.max_depth();
    }

  private:
    const OctreeCells& cells_;
    const Ray& ray_;
    RaySpan span_;
    std::array<bool, 3> moves_{};
};

namespace octree_detail {

/// Descends to the leaf that contains a unit.
template <class Stats>
std::uint32_t descend(const OctreeCells& cells, std::uint32_t node, const OctreeCells::Units& at,
                      Stats stats) {
    stats.nodes(1);
    while (!cells.nodes()[node].leaf) {
        node = cells.nodes()[node].first + cells.octant_of(cells.nodes()[node], at);
        stats.nodes(1);
    }
    return node;
}

/// The octant across a face, in the same parent or in the neighbor: table reflect(direction,
/// octant) of Samet.
inline std::uint32_t reflected(std::uint32_t octant, int axis) {
    return octant ^ 1u << axis;
}
/// True if an octant touches the face of its parent across `axis`: Samet's table adjacent.
inline bool adjacent(std::uint32_t octant, int axis, bool upper_face) {
    return (octant >> axis & 1u) == (upper_face ? 1u : 0u);
}

}  // namespace octree_detail

/// Locates every leaf from the root.
template <class Stats, class Visit>
void walk_by_point_location(const OctreeCells& cells, const OctreeRay& ray, Stats stats,
                            Visit&& visit) {
    OctreeCells::Units at = ray.units_at(ray.enter(), cells.nodes().front());
    for (;;) {
        const std::uint32_t leaf = octree_detail::descend(cells, 0, at, stats);
        const OctreeCells::Node& cell = cells.nodes()[leaf];
        const auto exit = ray.exit_of(cell);
        if (visit(leaf, exit.t) || !ray.units_beyond(exit, cell, at)) return;
    }
}

/// Ascends from a leaf to the nearest ancestor that contains the face inside, crosses it, and
/// descends by the mirrored path as far as nodes exist on it, then by the point.
template <class Stats, class Visit>
void walk_by_neighbors(const OctreeCells& cells, const OctreeRay& ray, Stats stats, Visit&& visit) {
    OctreeCells::Units at = ray.units_at(ray.enter(), cells.nodes().front());
    std::uint32_t leaf = octree_detail::descend(cells, 0, at, stats);
    for (;;) {
        const OctreeCells::Node& cell = cells.nodes()[leaf];
        const auto exit = ray.exit_of(cell);
        if (visit(leaf, exit.t) || !ray.units_beyond(exit, cell, at)) return;
        std::array<std::uint8_t, OctreeCells::kMostDepth + 1> path;
        int depth = 0;
        std::uint32_t node = leaf;
        bool crossed = false;
        while (!crossed) {
            const OctreeCells::Node& n = cells.nodes()[node];
            // Never reaches the root: units_beyond returned true.
            path[static_cast<std::size_t>(depth++)] = n.octant;
            crossed = !octree_detail::adjacent(n.octant, exit.axis, ray.upward(exit.axis));
            node = n.parent;
            stats.nodes(1);
        }
        while (depth > 0 && !cells.nodes()[node].leaf) {
            const std::uint32_t octant = path[static_cast<std::size_t>(--depth)];
            node = cells.nodes()[node].first + octree_detail::reflected(octant, exit.axis);
            stats.nodes(1);
        }
        leaf = cells.nodes()[node].leaf ? node : octree_detail::descend(cells, node, at, stats);
    }
}

/// Uses integers only: for every axis, the time at which the ray leaves the current node, in ticks.
/// A step adds the time through a cell of its size; a level up or down adds or subtracts half of
/// it.
template <class Stats, class Visit>
void walk_smart(const OctreeCells& cells, const OctreeRay& ray, Stats stats, Visit&& visit) {
    // The tick is chosen so that the slowest relevant crossing fits, and all halves are whole.
    constexpr int kTickBits = 44;
    constexpr double kNever = 0x1p61;
    const OctreeCells::Node& root = cells.nodes().front();
    const std::int32_t size = std::int32_t{1} << cells.max_depth();
    double fastest = std::numeric_limits<double>::infinity();
    std::array<double, 3> first{}, through{};
    for (int k = 0; k < 3; ++k) {
        const auto a = static_cast<std::size_t>(k);
        const double lo = ray.at_plane(k, 0), hi = ray.at_plane(k, size);
        first[a] = std::min(lo, hi);
        through[a] = std::abs(hi - lo);
        if (ray.moves(k)) fastest = std::min(fastest, through[a]);
    }
    const double per_tick = std::ldexp(1.0, kTickBits) / fastest;
    using Ticks = std::array<std::int64_t, 3>;
    Ticks leaves, step;  // leaves: when the root is left; step: time through it
    for (int k = 0; k < 3; ++k) {
        const auto a = static_cast<std::size_t>(k);
        const double ticks = ray.moves(k) ? through[a] * per_tick : kNever;
        // Written so that NaN, of a ray that is through in no time, never leaves.
        const double whole = ticks < kNever ? ticks : kNever;
        step[a] = static_cast<std::int64_t>(whole) >> cells.max_depth() << cells.max_depth();
        const double begin = ray.moves(k) ? (first[a] - ray.enter()) * per_tick : 0.0;
        leaves[a] = whole >= kNever
                        ? static_cast<std::int64_t>(kNever)
                        : static_cast<std::int64_t>(std::clamp(begin, -kNever, 0.0)) + step[a];
    }
    std::uint32_t node = 0;
    std::int64_t now = 0;
    // The first leaf is found by its point.
    OctreeCells::Units at = ray.units_at(ray.enter(), root);
    const auto down = [&](std::uint32_t octant) {
        for (std::size_t k = 0; k < 3; ++k) {
            step[k] /= 2;
            const bool upper = (octant >> k & 1) != 0;
            // The nearer half is left a step earlier.
            if (upper != ray.upward(static_cast<int>(k)) && leaves[k] < std::int64_t(kNever)) {
                leaves[k] -= step[k];
            }
        }
        node = cells.nodes()[node].first + octant;
        stats.nodes(1);
    };
    const auto up = [&] {
        const OctreeCells::Node& n = cells.nodes()[node];
        for (std::size_t k = 0; k < 3; ++k) {
            const bool upper = (n.octant >> k & 1) != 0;
            if (upper != ray.upward(static_cast<int>(k)) && leaves[k] < std::int64_t(kNever)) {
                leaves[k] += step[k];
            }
            step[k] *= 2;
        }
        node = n.parent;
        stats.nodes(1);
    };
    stats.nodes(1);
    while (!cells.nodes()[node].leaf) down(cells.octant_of(cells.nodes()[node], at));
    for (;;) {
        if (visit(node, ray.exit_of(cells.nodes()[node]).t)) return;
        const int axis = leaves[0] <= leaves[1] ? (leaves[0] <= leaves[2] ? 0 : 2)
                                                : (leaves[1] <= leaves[2] ? 1 : 2);
        const auto a = static_cast<std::size_t>(axis);
        now = std::max(now, leaves[a]);
        // Vertical: ascends to where the face lies inside the parent.
        while (node != 0 &&
               octree_detail::adjacent(cells.nodes()[node].octant, axis, ray.upward(axis))) {
            up();
        }
        if (node == 0) return;
        // Horizontal: to the sibling.
        const OctreeCells::Node& n = cells.nodes()[node];
        node = cells.nodes()[n.parent].first + octree_detail::reflected(n.octant, axis);
        leaves[a] += step[a];
        stats.nodes(1);
        // Descends: along every axis into the half that contains the ray.
        while (!cells.nodes()[node].leaf) {
            std::uint32_t octant = 0;
            for (int k = 0; k < 3; ++k) {
                const auto b = static_cast<std::size_t>(k);
                bool nearer = true;
                if (leaves[b] >= std::int64_t(kNever)) {
                    const std::int32_t middle =
                        cells.nodes()[node].origin[b] + cells.span(cells.nodes()[node]) / 2;
                    nearer = (at[b] < middle) == ray.upward(k);
                } else if (k != axis) {
                    nearer = leaves[b] - step[b] / 2 > now;
                }
                if (nearer != ray.upward(k)) octant |= 1u << k;
            }
            down(octant);
        }
    }
}

/// Descends from the root: the crossings with the middle planes determine the children that a ray
/// traverses.
template <class Stats, class Visit>
class ParametricWalk {
  public:
    ParametricWalk(const OctreeCells& cells, const OctreeRay& ray, double enter, Stats stats,
                   Visit& visit)
        : cells_(cells), ray_(ray), enter_(enter), stats_(stats), visit_(visit) {
        for (int k = 0; k < 3; ++k) {
            if (!ray.upward(k)) mirror_ |= 1u << k;
        }
    }

    /// True if the visit ended the traversal.
    bool walk(std::uint32_t index, const Vec3& t0, const Vec3& t1) {
        stats_.nodes(1);
        const OctreeCells::Node& node = cells_.nodes()[index];
        const double exit = std::min(t1.x, std::min(t1.y, t1.z));
        if (exit < enter_) return false;
        if (node.leaf) return visit_(index, exit);
        const std::int32_t half = cells_.span(node) / 2;
        Vec3 middle;
        for (int k = 0; k < 3; ++k) {
            const std::int32_t plane = node.origin[static_cast<std::size_t>(k)] + half;
            middle[k] = ray_.moves(k) ? ray_.at_plane(k, plane) : side_of(k, plane);
        }
        // In mirrored octants the ray runs upward along every axis: 1, 2, 4 for x, y, z.
        const double begin = std::max(t0.x, std::max(t0.y, t0.z));
        std::uint32_t octant = 0;
        for (int k = 0; k < 3; ++k) {
            if (middle[k] <= begin) octant |= 1u << k;
        }
        for (;;) {
            Vec3 from, to;
            for (int k = 0; k < 3; ++k) {
                const bool upper = (octant >> k & 1) != 0;
                from[k] = upper ? middle[k] : t0[k];
                to[k] = upper ? t1[k] : middle[k];
            }
            if (walk(node.first + (octant ^ mirror_), from, to)) return true;
            const int axis = to.x <= to.y ? (to.x <= to.z ? 0 : 2) : (to.y <= to.z ? 1 : 2);
            if ((octant >> axis & 1) != 0) return false;
            octant |= 1u << axis;
        }
    }

  private:
    /// For a ray parallel to the plane: it is always before or always behind the plane.
    [[nodiscard]] double side_of(int axis, std::int32_t plane) const {
        const bool upper = ray_.origin(axis) >= cells_.plane(axis, plane);
        const bool behind = upper != ((mirror_ >> axis & 1) != 0);
        return behind ? -std::numeric_limits<double>::infinity()
                      : std::numeric_limits<double>::infinity();
    }

    const OctreeCells& cells_;
    const OctreeRay& ray_;
    double enter_;
    Stats stats_;
    Visit& visit_;
    std::uint32_t mirror_ = 0;
};

template <class Stats, class Visit>
void walk_parametric(const OctreeCells& cells, const OctreeRay& ray, Stats stats, Visit&& visit) {
    Vec3 t0, t1;
    const std::int32_t size = std::int32_t{1} << cells.max_depth();
    for (int k = 0; k < 3; ++k) {
        t0[k] = ray.moves(k) ? ray.at_plane(k, ray.upward(k) ? 0 : size) : -kInfinity;
        t1[k] = ray.moves(k) ? ray.at_plane(k, ray.upward(k) ? size : 0) : kInfinity;
    }
    ParametricWalk<Stats, Visit>(cells, ray, ray.enter(), stats, visit).walk(0, t0, t1);
}

}  // namespace alhazen
