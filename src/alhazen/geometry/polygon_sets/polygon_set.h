#pragma once
/// A region of the plane bounded by lattice polygons, with any number of loops and holes.
///
/// Differs from a list of loops: a PolygonSet is canonical. Its loops are simple, do not cross and
/// share no edge; they may touch each other in points. Outer loops run counter-clockwise, holes
/// clockwise, so that the region is to the left of every edge. No vertex lies within a straight
/// line. Each loop begins at its least vertex, and loops are ordered by their first two vertices.
/// Equal regions have equal sets, except where a loop touches an edge of another.
/// Conventions: loops are stored one after another in one array of points. set_operations.h and
/// mending.h make sets. Complexity: as stated at each function, where n is the number of vertices.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "alhazen/geometry/polygon_sets/lattice.h"

namespace alhazen {

class PolygonSet {
  public:
    PolygonSet() = default;

    [[nodiscard]] bool empty() const { return ends_.empty(); }
    [[nodiscard]] std::size_t loop_count() const { return ends_.size(); }
    [[nodiscard]] std::size_t vertex_count() const { return points_.size(); }
    [[nodiscard]] std::span<const LatticePoint> loop(std::size_t i) const {
        const std::size_t begin = i == 0 ? 0 : ends_[i - 1];
        return std::span(points_).subspan(begin, ends_[i] - begin);
    }
    [[nodiscard]] const LatticeBox& bounds() const { return bounds_; }
    /// True if two loops have a common point.
    [[nodiscard]] bool touching() const { return touching_; }

    /// Makes the set empty and keeps its memory.
    void clear();
    /// Appends a vertex to the loop that `end_loop` will end. For makers of canonical sets.
    void add_vertex(LatticePoint p) {
        points_.push_back(p);
        bounds_.extend(p);
    }
    void end_loop() { ends_.push_back(static_cast<std::uint32_t>(points_.size())); }
    void set_touching(bool touching) { touching_ = touching; }
    void reserve(std::size_t vertices) { points_.reserve(vertices); }

    friend bool operator==(const PolygonSet& a, const PolygonSet& b) {
        return a.points_ == b.points_ && a.ends_ == b.ends_;
    }

  private:
    std::vector<LatticePoint> points_;
    std::vector<std::uint32_t> ends_;
    LatticeBox bounds_;
    bool touching_ = false;
};

[[nodiscard]] inline bool is_empty(const PolygonSet& set) {
    return set.empty();
}

/// The rectangle from lo to hi; empty if it has no area.
[[nodiscard]] PolygonSet lattice_rectangle(LatticePoint lo, LatticePoint hi);

/// Twice the signed area of a loop, positive if it runs counter-clockwise. O(n)
[[nodiscard]] Int128 twice_area(std::span<const LatticePoint> loop);

/// Twice the area of the region. O(n)
[[nodiscard]] Int128 twice_area(const PolygonSet& set);

enum class PointSide : std::uint8_t { Outside, Boundary, Inside };

/// The side of the region on which the point lies. O(n)
[[nodiscard]] PointSide side_of_point(const PolygonSet& set, LatticePoint p);

/// True if the point is inside or on the boundary. O(n)
[[nodiscard]] bool contains(const PolygonSet& set, LatticePoint p);

/// A connected piece of the region: an outer loop and the holes directly inside it.
struct OuterLoop {
    std::uint32_t outer = 0;           ///< index of the loop
    std::vector<std::uint32_t> holes;  ///< indices of loops
};

/// The pieces of the region, in the order of the outer loops. O(n log n)
[[nodiscard]] std::vector<OuterLoop> loops_with_holes(const PolygonSet& set);

using LatticeTriangle = std::array<LatticePoint, 3>;

/// Counter-clockwise triangles that tile the region, on its own vertices. Their areas add up to the
/// area of the region exactly. O(n log n)
[[nodiscard]] std::vector<LatticeTriangle> triangulate(const PolygonSet& set);

}  // namespace alhazen
