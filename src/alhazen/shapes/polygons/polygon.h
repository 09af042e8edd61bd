#pragma once
/// A planar polygon of one or several loops, concave or with holes; inside by the odd-even rule.
///
/// Source: Foley, van Dam et al., "Computer Graphics", section 15.10.1 (drop the axis along which
/// the normal is longest).
/// Differs: the plane's normal is Newell's, over all loops, or where parts of opposite orientation
/// cancel (a bow tie), that of a triangle of vertices (geometry/polygon/polygon_plane.h); the point
/// is projected along the ray instead of an axis, by the shear and the exact edge signs of
/// geometry/watertight_triangle.h.
/// Polygons that share vertices bit for bit, in one plane or around a solid, thus have no gap and
/// no double hit: a ray through a shared edge or vertex hits exactly one of them. The plane only
/// determines t.
/// Conventions: counter-clockwise from the side of the normal. uv are coordinates in the plane,
/// from the first vertex along the first edge. Vertices need not be coplanar; a hit lies in the
/// mean plane.
/// Complexity: O(vertices) for a ray that crosses the plane within the polygon's box, else O(1).
/// Polygons of many corners have cells (polygon_cells.h): O(1), with the same hits, except near an
/// edge, for grazing rays, and for polygons that are not flat.

#include <memory>

#include "alhazen/shapes/core/shape.h"

namespace alhazen {

class PolygonCells;

struct Polygon {
    static constexpr const char* kName = "polygon";
    static constexpr int kMaxHits = 1;
    static constexpr bool kClosed = false;

    std::vector<Vec3> vertices;            ///< vertices of all loops, consecutive
    std::vector<std::uint32_t> loop_ends;  ///< [loop] one past its last vertex; empty: one loop
    Vec3 point{};                          ///< derived: on the plane
    Vec3 normal{0, 0, 1};                  ///< derived: unit
    Vec3 u_axis{1, 0, 0};                  ///< derived: unit, in the plane, along the first edge
    Box3 bounds{};         ///< derived: of the vertices and their projections to the plane
    double off_plane = 0;  ///< derived: largest distance of a vertex from the plane
    std::shared_ptr<const PolygonCells> cells;  ///< derived: null with few corners

    static constexpr auto kFields =
        std::make_tuple(field("vertices", &Polygon::vertices, Unit::Compound, Check::Shape),
                        field("loop_ends", &Polygon::loop_ends, Unit::Compound, Check::Shape));

    void prepare();
    void validate(const FileLocation& where, Diagnostics& diagnostics) const;
    [[nodiscard]] bool closed() const { return false; }
    [[nodiscard]] Box3 box() const;
    [[nodiscard]] Interval extent(const Vec3& axis) const;
    int intersect(const Ray& ray, ShapeHit* hits) const;
    [[nodiscard]] ShapeSurface surface(const Ray& ray, const ShapeHit& hit) const;
};

}  // namespace alhazen
