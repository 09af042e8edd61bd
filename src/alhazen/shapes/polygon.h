#pragma once
/// A planar polygon of one or several loops, concave or with holes; inside by the odd-even rule.
///
/// Source: Foley, van Dam et al., "Computer Graphics", section 15.10.1 (drop the axis along which the normal
/// is longest).
/// Differs: the plane's normal is Newell's, over all loops; an edge belongs to one of its two sides (half-open
/// rule), so polygons that share an edge are crossed exactly once there.
/// Conventions: counter-clockwise from the side the normal points to. uv are coordinates in the plane, from the
/// first vertex along the first edge.

#include "alhazen/shapes/shape.h"

namespace alhazen {

struct Polygon {
    static constexpr const char* kName = "polygon";
    static constexpr int kMaxHits = 1;
    static constexpr bool kClosed = false;

    std::vector<Vec3> vertices;             ///< all loops, one after another
    std::vector<std::uint32_t> loop_ends;   ///< end (one past the last vertex) of each loop
    Vec3 point;                             ///< derived: on the plane
    Vec3 normal;                            ///< derived: unit

    void prepare();
    void validate(const FileLocation& where, Diagnostics& diagnostics) const;
    [[nodiscard]] bool closed() const { return false; }
    [[nodiscard]] Box3 box() const;
    [[nodiscard]] Interval extent(const Vec3& axis) const;
    int intersect(const Ray& ray, ShapeHit* hits) const;
    [[nodiscard]] ShapeSurface surface(const Ray& ray, const ShapeHit& hit) const;
};

}  // namespace alhazen
