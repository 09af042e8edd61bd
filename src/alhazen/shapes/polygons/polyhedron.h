#pragma once
/// A convex polyhedron: by its planes, or by vertices and faces.
///
/// Source: Haines, "Fast Ray-Convex Polyhedron Intersection", Graphics Gems II, 1991 (intersection
/// of the line's intervals in the half spaces).
/// Differs: a line in the plane of a face is inside or outside by `keeps_face`.
/// Conventions: the solid is the intersection of the half spaces of all planes, so that a line
/// crosses it twice or not at all. Faces by vertices may have either winding, may repeat vertices,
/// and need be planar only approximately: the plane is the mean one (Newell). part = the plane or
/// face; uv are coordinates in its plane along two unit vectors from its point.
/// Complexity: O(planes) per ray.

#include "alhazen/geometry/polygon/convex_corners.h"
#include "alhazen/shapes/core/shape.h"

namespace alhazen {

struct Polyhedron {
    static constexpr const char* kName = "polyhedron";
    static constexpr int kMaxHits = 2;
    static constexpr bool kClosed = true;

    std::vector<OrientedPlane> planes;  ///< normals of any length; if empty, faces are given by:
    std::vector<Vec3> vertices;
    std::vector<std::uint32_t> corners;    ///< vertex numbers of all faces, consecutive
    std::vector<std::uint32_t> face_ends;  ///< [face] one past its last corner

    std::vector<OrientedPlane> faces;  ///< derived: [part], unit normals
    Box3 bounds{};                     ///< derived: rounded outward
    std::vector<Vec3> hull;            ///< derived: the true corners, each slightly moved outward

    static constexpr auto kFields =
        std::make_tuple(field("planes", &Polyhedron::planes, Unit::Compound, Check::Shape),
                        field("vertices", &Polyhedron::vertices, Unit::Compound, Check::Shape),
                        field("corners", &Polyhedron::corners, Unit::Compound, Check::Shape),
                        field("face_ends", &Polyhedron::face_ends, Unit::Compound, Check::Shape));

    void prepare();
    void validate(const FileLocation& where, Diagnostics& diagnostics) const;
    [[nodiscard]] bool closed() const { return true; }
    [[nodiscard]] Box3 box() const { return bounds; }
    [[nodiscard]] Interval extent(const Vec3& axis) const;
    int intersect(const Ray& ray, ShapeHit* hits) const;
    [[nodiscard]] ShapeSurface surface(const Ray& ray, const ShapeHit& hit) const;
};

/// The hexahedron with the bottom 0 1 2 3 and above it the top 4 5 6 7. Points may coincide (a
/// wedge, a pyramid, a tetrahedron); faces without area are omitted.
[[nodiscard]] Polyhedron hexahedron(const std::array<Vec3, 8>& points);

}  // namespace alhazen
