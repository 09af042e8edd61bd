#pragma once
/// A binary space partition of convex polygons, with a convex hull of the contents of each node.
///
/// Source: Fuchs, Kedem and Naylor, "On Visible Surface Generation by a Priori Tree Structures",
/// SIGGRAPH 1980 (planes of polygons; the side of the eye orders the rest); Dadoun, Kirkpatrick and
/// Walsh, "The Geometry of Beam Tracing", Computational Geometry 1985 (hulls merged bottom-up; a
/// beam skips subtrees whose hull it misses).
/// Differs: if every candidate plane leaves nearly all polygons on one side, as in a closed convex
/// mesh, axis-aligned planes through the middle of the polygons are candidates too; otherwise the
/// tree would be a list. Hulls of more than 32 corners are replaced by an enclosing polytope
/// (point_hull.h), so that the test of a beam costs the same at every node. Many polygons of one
/// plane form a tree of their own, for its hulls: they do not hide each other, and are divided at
/// the middle along an axis.
/// Conventions: corners nearer to a plane than `margin` lie in it. The tree depends only on the
/// polygons and their order.
/// Complexity: O(n log n) to build if planes divide well. Threads: immutable once built.

#include <cstdint>
#include <span>
#include <vector>

#include "alhazen/geometry/facets/facet_pool.h"

namespace alhazen {

struct FacetTreeOptions {
    std::uint32_t candidates = 8;  ///< number of polygon planes rated at each node
};

struct FacetTreeReport {
    std::uint64_t polygons = 0;  ///< input polygons
    std::uint64_t splits = 0;    ///< divisions of a polygon into two pieces
    std::uint64_t pieces = 0;    ///< pieces in the tree
    std::uint64_t nodes = 0;
    std::uint32_t depth = 0;
};

class FacetTree {
  public:
    static constexpr std::uint32_t kNone = 0xFFFFFFFFu;
    struct Node {
        FacetPlane plane;
        std::uint32_t before = kNone, behind = kNone;  ///< children on either side
        std::uint32_t in = kNone;                      ///< tree of the pieces in the plane
        std::uint32_t first = 0, count = 0;            ///< range of the pieces in the plane
        std::uint32_t first_corner = 0, corners = 0;   ///< range of the hull's corners
    };

    FacetTree() = default;
    /// Builds the tree of convex polygons of the pool.
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
    /// The distance below which differences are rounding errors.
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

/// Planes around a beam; a point within the beam lies in front of all of them.
using BeamSides = std::vector<FacetPlane>;

struct FacetWalkCounts {
    std::uint64_t hulls = 0;     ///< tested, including polygons in the planes of nodes
    std::uint64_t missed = 0;    ///< tested hulls that the beam misses
    std::uint64_t polygons = 0;  ///< polygons returned

    FacetWalkCounts& operator+=(const FacetWalkCounts& other) {
        hulls += other.hulls;
        missed += other.missed;
        polygons += other.polygons;
        return *this;
    }
};

/// A front-to-back traversal of the tree. May be copied on the way, for parts of a beam.
class FacetWalk {
  public:
    /// `reject`: skip subtrees and polygons that lie outside one of the sides.
    FacetWalk(const FacetTree& tree, const BeamApex& apex, bool reject = true)
        : tree_(&tree), apex_(apex), reject_(reject) {
        if (!tree.empty()) stack_.push_back({0, true});
    }

    /// The next piece; without rejection, all pieces of the next node that has any. Empty at the
    /// end.
    [[nodiscard]] std::span<const FacetPiece> next(const BeamSides& sides, FacetWalkCounts& counts);

  private:
    struct Waiting {
        std::uint32_t node;
        bool whole;              ///< true: the subtree; false: the pieces of the node
        std::uint32_t from = 0;  ///< first of these pieces to visit
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

/// True if all points lie behind one of the planes, by more than `margin`.
[[nodiscard]] bool misses(std::span<const Vec3> points, const BeamSides& sides, double margin);

}  // namespace alhazen
