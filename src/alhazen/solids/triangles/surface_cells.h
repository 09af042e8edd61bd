#pragma once
/// The surface of a solid on an octree: cells are small where the surface needs them.
///
/// Source: Ju, Losasso, Schaefer and Warren, "Dual Contouring of Hermite Data", SIGGRAPH 2002: one
/// vertex per cell that the surface passes through, nearest to the tangent planes at its crossings
/// with the cell's edges; one polygon around each edge that the surface crosses. Differs: a cell
/// has a vertex for each sheet of the surface in it (cell_sheets.h).
/// No function is sampled. The spans of lines along z tell which corners are inside;
/// crossings and normals are exact. Cells are divided, not merged: where a face is not near the
/// surface, or a line meets what the cells do not show. What was tested and has not changed is not
/// tested again.
/// Conventions: the frame of the solid's scene. Lengths of the tree are in units of its smallest
/// cells, whose faces need no test. Threads: used by one thread; faces are tested by several, with
/// the same result for any number.
/// Complexity: O(cells that the surface passes through, or that boxes of parts overlap), in time,
/// memory and lines.

#include <array>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "alhazen/solids/triangles/face_tests.h"
#include "alhazen/solids/triangles/surface_faces.h"
#include "alhazen/solids/triangles/surface_line.h"

namespace alhazen {

class CellSheets;

class SurfaceCells {
  public:
    using Crossing = SurfaceCrossing;
    using Edge = SurfaceEdge;
    using Vertex = SurfaceVertex;
    using Face = SurfaceFace;

    /// The largest cells that the surface may pass have the size `cell`, the smallest 2^-`halvings`
    /// of it. `coordinates`: gets the places of crossings, unless null. The solid and they must
    /// outlive the object.
    SurfaceCells(const IsolatedSolid& solid, double cell, int halvings, double tolerance,
                 SolidCoordinates* coordinates);

    /// Divides cells until all faces are within half the tolerance. False if there would be more
    /// triangles than given; then there is no result.
    bool divide(std::uint64_t max_triangles);
    /// After `divide` was false: a tolerance within which faces were before there were too many, as
    /// far as some of them tell, at least twice the own; 0 if none is known.
    [[nodiscard]] double larger_tolerance() const;
    /// The number of leaves of the solid, or gaps that they leave, thinner than the tolerance and
    /// with no face beside a point in them.
    [[nodiscard]] std::size_t lost_parts() const;

    [[nodiscard]] const std::vector<Edge>& edges() const { return edges_; }
    [[nodiscard]] Face face(const Edge& edge) const;
    [[nodiscard]] const Vertex& vertex(std::uint32_t number) const { return vertices_[number]; }
    /// Some are of no face.
    [[nodiscard]] std::size_t vertex_count() const { return vertices_.size(); }

  private:
    using Node = CellTree::Node;
    static constexpr std::uint32_t kNone = 0xFFFFFFFFu;

    /// A part of a line along an axis inside the solid, or a gap in it.
    struct Part {
        Vec3 from;
        std::size_t axis;
        Interval range;
        bool is_inside;
    };

    [[nodiscard]] Vec3 position(const Node& n) const {
        return origin_ + unit_ * Vec3{double(n[0]), double(n[1]), double(n[2])};
    }
    [[nodiscard]] bool is_least(std::uint32_t cell) const { return tree_[cell].size == 1; }
    [[nodiscard]] const Vec3& point(std::uint32_t number) const { return vertices_[number].point; }

    // ---- Division.
    /// Divides cells that a box overlaps until none exceeds a size.
    void split_to(std::uint32_t cell, const Box3& box, std::uint32_t size);
    /// Divides the cells in the box of a part of the surface to half its least side, or into about
    /// `most`.
    void split_part(const Box3& part, double most);
    /// Divides cells that hide a part of the solid, or a gap in it: lines along the axes of a part
    /// of the surface are as far apart as its least side, or about `most` along each axis.
    void start_part(const IsolatedSolid::SurfacePart& part, std::size_t number, double most);
    /// Divides the cell at a point until its corners are on the same side of the surface. False,
    /// without a division, if the surface is within half the tolerance.
    bool start_at(const Vec3& p);
    /// Lets the largest of the cells around an edge be divided, unless they are the smallest.
    void ask(const CellTree::Edge& edge);
    void ask(std::uint32_t cell);
    /// False if no division was asked for.
    bool split_cells();

    // ---- Lines along the edges of cells.
    /// Where a line along an axis, through a node at 0, enters and leaves the solid.
    std::span<const double> ends_of(const Node& through, std::size_t axis);
    void forget_lines();
    bool is_in(const Node& n);
    /// False if a part of the solid, or a gap in it, that is thicker than the tolerance lies within
    /// the edge.
    bool sees_all(const CellTree::Edge& edge);

    // ---- Edges.
    /// Removes the edges of cells that were divided.
    void drop_edges();
    /// Adds the edges of new cells that the surface crosses; no more once there are more triangles
    /// than given.
    void find_edges(std::uint64_t max_triangles);
    Crossing find_crossing(const CellTree::Edge& edge, bool starts_in);

    // ---- Vertices, of cells whose crossings have changed.
    void place_vertices();
    void place_vertex(std::uint32_t cell, std::span<const std::uint32_t> uses,
                      const CellSheets& sheets, std::uint32_t sheet);

    // ---- Tests of faces.
    /// Deviation of the two triangles beside a diagonal from the surface normal: the negated least
    /// cosine.
    [[nodiscard]] double badness(const Face& face, std::size_t first, const Vec3& normal) const;
    /// Asks for a division of cells whose faces are not near the surface.
    void test_faces();

    // ---- Lines that are not edges of cells.
    /// Asks for a division of cells that the surface seems not to pass through, in which the middle
    /// of a part is that is thicker than the tolerance.
    void test_lines();
    void find_parts();
    /// The leaf that a point is in.
    [[nodiscard]] std::uint32_t leaf_at(const Vec3& p) const;
    /// True if a cell of a tree that overlaps a box has a vertex.
    [[nodiscard]] bool any_vertex(std::uint32_t cell, const Box3& box) const;

    const IsolatedSolid& solid_;
    SurfaceLine line_;
    double cell_, unit_, limit_, spacing_;  ///< `limit_`: half the tolerance
    Box3 box_;
    Vec3 origin_;
    CellTree tree_;
    FaceTests tests_;
    SolidCoordinates* coordinates_;
    std::vector<Edge> edges_;
    std::vector<Vertex> vertices_;
    std::vector<std::uint32_t> vertex_of_;             ///< [cell] that of its first sheet
    std::vector<std::uint8_t> is_changed_, is_asked_;  ///< [cell]
    std::vector<std::uint32_t> asked_;                 ///< cells to divide
    std::vector<Part> parts_;                          ///< of lines, to be found in the cells
    bool has_parts_ = false;
    struct ThinPoint {
        Vec3 point;
        std::size_t part;  ///< of `surface_parts`
    };
    std::vector<ThinPoint> thin_points_;  ///< where `start_at` was false, part by part
    std::vector<double> distances_;       ///< of some faces of the last test that are not near
    std::vector<Crossing> crossings_;     ///< of one sheet
    /// Of lines along each axis, the range of `ends_`.
    std::array<std::unordered_map<std::uint64_t, std::pair<std::size_t, std::size_t>>, 3> lines_;
    std::vector<double> ends_;
};

}  // namespace alhazen
