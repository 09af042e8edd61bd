#pragma once
/// Polygons of the polygon table: the quadrilateral of a flat sub-patch, and a facet, each with its
/// edge list.
///
/// Conventions: a quadrilateral is two triangles at the diagonal from (u0, v0) to (u1, v1); a
/// triangle consists of the samples on the inner sides of three lines, so that neighbours at one
/// line partition the samples, whatever their corners are. A facet is inside by the odd-even rule.

#include <array>
#include <vector>

#include "alhazen/renderers/lane_carpenter/edge_line.h"
#include "alhazen/renderers/lane_carpenter/sub_patch.h"

namespace alhazen {

/// A triangle of a quadrilateral.
struct ScanTriangle {
    std::array<std::uint8_t, 3> corners{}, lines{};
    std::array<bool, 3> inner_right{};  ///< [line] the inside is to the right
    bool empty = true;                  ///< it degenerates to a line in the picture
    NearnessPlane nearness;             ///< in grid units, not pixels
    double least = 0, most = 0;         ///< nearness of the corners
};

struct ScanQuad {
    struct Corner {
        FixedPoint at;
        double nearness = 0, share = 0;  ///< share: 1 / w
        double u = 0, v = 0;
    };

    std::uint32_t piece = 0;
    std::uint32_t next = 0;  ///< in the bucket
    std::int32_t first_row = 0, end_row = 0;
    std::array<Corner, 4> corners;  ///< (0, 0), (1, 0), (1, 1), (0, 1)
    std::array<EdgeLine, 5> lines;  ///< the sides, and the diagonal
    std::array<ScanTriangle, 2> triangles;
    std::array<std::uint64_t, 4> seams{};

    /// u and v of a point of a triangle, from the grid.
    [[nodiscard]] Vec2 parameters_at(std::size_t triangle, double x, double y) const;
};

/// Makes the quadrilateral of a sub-patch whose step is Draw. `with_chords`: straight sides lie on
/// their chords.
void set_quad(const ScreenView& view, const SampleGrid& grid, int degree_u, int degree_v,
              const SubPatch& patch, bool with_chords, ScanQuad& quad);

struct ScanOutline {
    std::uint32_t facet = 0;
    std::uint32_t next = 0;  ///< in the bucket
    std::int32_t first_row = 0, end_row = 0;
    std::vector<EdgeLine> lines;
    NearnessPlane nearness;  ///< in grid units
};

/// Clips the loops of a facet in screen space to the view and makes their edge list; false if it is
/// invisible. `plane` is in pixels.
bool set_outline(const ScreenView& view, const SampleGrid& grid,
                 std::vector<std::vector<HomogeneousPoint>>& loops, const NearnessPlane& plane,
                 ScanOutline& outline);

}  // namespace alhazen
