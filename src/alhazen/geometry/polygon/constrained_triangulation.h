#pragma once
/// A triangulation of a region of the plane into which points and borders are inserted; the borders
/// divide it into the triangles inside and outside of them.
///
/// Source: Lawson, "Software for C1 Surface Interpolation", Mathematical Software III, 1977
/// (insertion of points, flips to Delaunay's triangulation); Sloan, "A fast algorithm for
/// generating constrained Delaunay triangulations", Computers & Structures 47, 1993 (edges by flips
/// of the edges that they cross).
/// Differs: edges of the given triangulation and borders are fixed: no flip removes them, and where
/// a border crosses one, both are divided at a common vertex. Signs are exact; an edge is divided
/// only where all triangles stay counter-clockwise (rounding moves the vertex), else it or the
/// border goes through the vertex that is there up to rounding.
/// Conventions: a vertex is shared by all its triangles, so that none lies within an edge. A border
/// inserted twice is none: borders may overlap, touch and cross.
/// Complexity: O(triangles) memory; a border takes time for the triangles that it crosses, and a
/// point for those on the way from the point before it.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "alhazen/math/vec.h"

namespace alhazen {

class ConstrainedTriangulation {
  public:
    using Triangle = std::array<std::uint32_t, 3>;

    /// Preconditions: counter-clockwise triangles with area that tile a convex region edge to edge;
    /// every point is a corner of one; coordinates are of the size 1.
    ConstrainedTriangulation(std::vector<Vec2> points, std::span<const Triangle> triangles);

    /// The vertex at a point of the region, a new one if there is none within `near`. A new one
    /// within `near` of an edge inside the region divides it.
    std::uint32_t insert(const Vec2& p, double near = 0.0);

    /// Inserts the border from one vertex to another, or takes it away where it is one.
    void connect(std::uint32_t from, std::uint32_t to);

    /// Divides each border within the region at its middle if `is_long` says so of its ends.
    template <class IsLong>
    void divide_borders(const IsLong& is_long) {
        const std::size_t count = origins_.size();
        for (std::uint32_t h = 0; h < count; ++h) {
            if ((flags_[h] & kBorder) == 0 || twins_[h] == kNone || twins_[h] < h) continue;
            const Vec2 a = points_[origins_[h]], b = points_[origins_[next(h)]];
            if (is_long(a, b)) (void)split_if_valid(h, 0.5 * (a + b));
        }
    }

    /// Flips edges that are not fixed until the triangulation is Delaunay's between fixed ones.
    void improve();

    /// The triangles that an even number of borders separates from `seed`, or an odd number.
    [[nodiscard]] std::vector<Triangle> triangles(std::uint32_t seed, bool even) const;
    /// The index of the triangle of the largest area.
    [[nodiscard]] std::uint32_t largest() const;

    [[nodiscard]] Triangle triangle(std::uint32_t index) const {
        return {origins_[3 * index], origins_[3 * index + 1], origins_[3 * index + 2]};
    }
    [[nodiscard]] const std::vector<Vec2>& points() const { return points_; }
    [[nodiscard]] std::size_t triangle_count() const { return origins_.size() / 3; }

  private:
    static constexpr std::uint32_t kNone = 0xFFFFFFFFu;
    enum Flag : std::uint8_t { kFixed = 1, kBorder = 2 };

    static std::uint32_t next(std::uint32_t h) { return h % 3 == 2 ? h - 2 : h + 1; }
    static std::uint32_t previous(std::uint32_t h) { return h % 3 == 0 ? h + 2 : h - 1; }

    /// Calls visit(h) for the half-edges out of a vertex until it returns true.
    template <class Visit>
    bool visit_out(std::uint32_t vertex, const Visit& visit) const {
        const std::uint32_t first = out_[vertex];
        std::uint32_t h = first;
        do {
            if (visit(h)) return true;
            h = twins_[previous(h)];
        } while (h != kNone && h != first);
        if (h == first) return false;
        for (h = twins_[first]; h != kNone; h = twins_[h]) {
            h = next(h);
            if (visit(h)) return true;
        }
        return false;
    }
    [[nodiscard]] int side(std::uint32_t a, std::uint32_t b, std::uint32_t c) const;
    [[nodiscard]] std::uint32_t edge_between(std::uint32_t a, std::uint32_t b) const;
    [[nodiscard]] std::uint32_t locate(const Vec2& p) const;
    void link(std::uint32_t h, std::uint32_t twin, std::uint8_t flags);
    std::uint32_t add_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c);
    std::uint32_t add_vertex(const Vec2& p);
    std::uint32_t split_face(std::uint32_t triangle, const Vec2& p);
    std::uint32_t split_edge(std::uint32_t h, const Vec2& p);
    std::uint32_t split_if_valid(std::uint32_t h, const Vec2& p);
    [[nodiscard]] bool fits(std::uint32_t h, const Vec2& p) const;
    bool remove_sliver(std::uint32_t h);
    void flip(std::uint32_t h);
    [[nodiscard]] bool can_flip(std::uint32_t h) const;
    [[nodiscard]] bool should_flip(std::uint32_t h) const;
    void legalize(std::vector<std::uint32_t> open);

    struct Advance {
        std::uint32_t vertex;
        bool reached;  ///< false: the vertex is to be reached first
    };
    using Edge = std::array<std::uint32_t, 2>;
    Advance advance(std::uint32_t from, std::uint32_t to, bool flips);
    Advance divide(std::uint32_t from, std::uint32_t to, std::uint32_t h);
    bool clear(std::uint32_t from, std::uint32_t to, std::vector<Edge> crossed);
    void toggle(std::uint32_t h);
    void connect_along_edges(std::uint32_t from, std::uint32_t to);

    std::vector<Vec2> points_;
    std::vector<std::uint32_t> origins_;  ///< [half-edge]; three to a triangle
    std::vector<std::uint32_t> twins_;    ///< [half-edge]; kNone on the rim
    std::vector<std::uint8_t> flags_;     ///< [half-edge]; the same for both of an edge
    std::vector<std::uint32_t> out_;      ///< [vertex] a half-edge that begins there
    mutable std::uint32_t last_ = 0;      ///< the triangle found last
};

}  // namespace alhazen
