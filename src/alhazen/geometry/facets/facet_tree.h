#pragma once
/// A binary space partition of convex polygons, with a convex hull around what each node holds.
///
/// Source: Fuchs, Kedem and Naylor, "On Visible Surface Generation by a Priori Tree Structures",
/// SIGGRAPH 1980 (planes of polygons; the side of the eye orders the rest); Dadoun, Kirkpatrick and
/// Walsh, "The Geometry of Beam Tracing", Computational Geometry 1985 (hulls merged bottom-up; a
/// beam leaves subtrees whose hull it misses).
/// Differs: where every candidate leaves nearly all polygons on one side, as in a closed convex
/// mesh, a plane across the axes at the middle of the polygons is a candidate too; without it such
/// a tree is a list. Hulls of more than 32 corners are replaced by a polytope around them
/// (point_hull.h), so that the test of a beam costs the same at every node.
/// Many polygons of one plane have a tree of their own, for its hulls: they do not hide each other,
/// and are divided at the middle along an axis.
/// Conventions: corners nearer to a plane than `margin` lie in it. The tree depends on the polygons
/// and their order alone.
/// Complexity: O(n log n) to build where planes divide well. Threads: immutable once built.

#include <cstdint>
#include <span>
#include <vector>

#include "alhazen/geometry/facets/facet_pool.h"

namespace alhazen {

struct FacetTreeOptions {
    std::uint32_t candidates = 8;  ///< planes of polygons rated at each node
    double split_cost = 4;         ///< of a polygon that is cut, in polygons out of balance
};

struct FacetTreeReport {
    std::uint64_t polygons = 0;  ///< given
    std::uint64_t splits = 0;    ///< each makes two pieces of one
    std::uint64_t pieces = 0;    ///< in the tree
    std::uint64_t nodes = 0, hull_corners = 0;
    std::uint64_t free_planes = 0;  ///< nodes whose plane holds no polygon
    std::uint32_t depth = 0;
};

class FacetTree {
  public:
    static constexpr std::uint32_t kNone = 0xFFFFFFFFu;
    struct Node {
        FacetPlane plane;
        std::uint32_t before = kNone, behind = kNone;  ///< children, on the side of the normal
        std::uint32_t in = kNone;                      ///< a tree of the pieces in the plane
        std::uint32_t first = 0, count = 0;            ///< pieces in the plane
        std::uint32_t first_corner = 0, corners = 0;   ///< of the hull
    };

    FacetTree() = default;
    /// Convex polygons of the pool.
    FacetTree(FacetPool pool, std::vector<FacetPiece> polygons,
              const FacetTreeOptions& options = {});

    [[nodiscard]] bool empty() const { return nodes_.empty(); }
    [[nodiscard]] const Node& node(std::uint32_t n) const { return nodes_[n]; }
    [[nodiscard]] std::span<const FacetPiece> pieces(const Node& node) const {
        return std::span(pieces_).subspan(node.first, node.count);
    }
    [[nodiscard]] std::span<const FacetPiece> pieces() const { return pieces_; }
    [[nodiscard]] std::span<const Vec3> hull(const Node& node) const {
        return std::span(hull_points_).subspan(node.first_corner, node.corners);
    }
    [[nodiscard]] const FacetPool& pool() const { return pool_; }
    [[nodiscard]] const FacetTreeReport& report() const { return report_; }
    /// Distances below it are rounding.
    [[nodiscard]] double margin() const { return margin_; }

  private:
    friend class FacetTreeBuilder;
    FacetPool pool_;
    std::vector<Node> nodes_;
    std::vector<FacetPiece> pieces_;
    std::vector<Vec3> hull_points_;
    FacetTreeReport report_;
    double margin_ = 0;
};

/// Planes around a beam; a point within lies before all of them.
using BeamSides = std::vector<FacetPlane>;

struct FacetWalkCounts {
    std::uint64_t hulls = 0;     ///< tested; a polygon in the plane of a node is a hull of its own
    std::uint64_t missed = 0;    ///< of these, those that the beam misses
    std::uint64_t polygons = 0;  ///< handed out

    FacetWalkCounts& operator+=(const FacetWalkCounts& other) {
        hulls += other.hulls;
        missed += other.missed;
        polygons += other.polygons;
        return *this;
    }
};

/// A visit of the tree, nearest polygons first. May be copied on the way, for parts of a beam.
class FacetWalk {
  public:
    /// `reject`: leave subtrees whose hull lies outside one of the sides, and polygons that do.
    FacetWalk(const FacetTree& tree, const BeamApex& apex, bool reject = true)
        : tree_(&tree), apex_(apex), reject_(reject) {
        if (!tree.empty()) stack_.push_back({0, true});
    }

    /// The next piece, or all the pieces of the next node that has any where nothing is rejected;
    /// empty at the end.
    [[nodiscard]] std::span<const FacetPiece> next(const BeamSides& sides, FacetWalkCounts& counts);

  private:
    struct Waiting {
        std::uint32_t node;
        bool whole;              ///< the subtree; otherwise the pieces of the node
        std::uint32_t from = 0;  ///< of these, those from here on
    };
    /// The next piece of a node that the sides do not reject.
    [[nodiscard]] std::span<const FacetPiece> next_in(const Waiting& waiting,
                                                      const BeamSides& sides,
                                                      FacetWalkCounts& counts);

    const FacetTree* tree_;
    BeamApex apex_;
    bool reject_;
    std::vector<Waiting> stack_;
};

/// Whether all points lie behind one of the planes, farther than `margin`.
[[nodiscard]] bool misses(std::span<const Vec3> points, const BeamSides& sides, double margin);

}  // namespace alhazen
