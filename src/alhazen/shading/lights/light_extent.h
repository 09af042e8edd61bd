#pragma once
/// Surfaces of area lights, and their sampling.
///
/// Source: Shirley and Chiu, "A Low Distortion Map Between Disk and Square", JGT 2(3), 1997 (discs,
/// cones); Shirley, Wang and Zimmerman, "Monte Carlo Techniques for Direct Lighting Calculations",
/// ACM TOG 15(1), 1996 (the sphere by its cone, polygons by area); Turk, "Generating Random Points
/// in Triangles", in Graphics Gems, 1990.
/// Differs: only the half of a tube that faces the point is sampled.
/// Conventions: densities are by solid angle at the lit point, for multiple importance sampling.
/// Spheres are sampled uniformly by solid angle, all others by area. The outer side is that of the
/// normal: of a rectangle edge_u x edge_v, of polygons and triangles the side from which they run
/// anticlockwise.
/// Complexity: O(1); O(log n) for n triangles. Threads: const functions may be called concurrently.

#include <array>
#include <cstdint>
#include <variant>
#include <vector>

#include "alhazen/math/vec.h"

namespace alhazen {

struct RectangleExtent {
    Vec3 corner{-0.5, -0.5, 0}, edge_u{1, 0, 0}, edge_v{0, 1, 0};
    friend bool operator==(const RectangleExtent&, const RectangleExtent&) = default;
};
struct DiscExtent {
    Vec3 center, normal{0, 0, 1};
    double radius = 1, inner_radius = 0;
    friend bool operator==(const DiscExtent&, const DiscExtent&) = default;
};
struct SphereExtent {
    Vec3 center;
    double radius = 1;
    friend bool operator==(const SphereExtent&, const SphereExtent&) = default;
};
/// The lateral surface of a cylinder, without caps.
struct TubeExtent {
    Vec3 base, top{0, 0, 1};
    double radius = 0.05;
    friend bool operator==(const TubeExtent&, const TubeExtent&) = default;
};
/// A planar polygon of one loop; inside by the odd-even rule.
struct PolygonExtent {
    std::vector<Vec3> vertices;
    friend bool operator==(const PolygonExtent&, const PolygonExtent&) = default;
};
struct MeshExtent {
    std::vector<Vec3> points;
    std::vector<std::array<std::uint32_t, 3>> triangles;
    friend bool operator==(const MeshExtent&, const MeshExtent&) = default;
};
using LightExtent =
    std::variant<RectangleExtent, DiscExtent, SphereExtent, TubeExtent, PolygonExtent, MeshExtent>;

/// A point of a light as seen from a lit point.
struct ExtentSample {
    Vec3 to_light;  ///< unit
    Vec3 normal;    ///< unit, of the outer side
    double distance = 0;
    double density = 0;  ///< density by solid angle; 0: the point is not lit from there
};

/// An extent ready for sampling.
class LightSurface {
  public:
    /// Triangles of a mesh whose areas are projected one by one.
    static constexpr std::size_t kMostTriangles = 256;

    LightSurface(const LightExtent& extent, bool two_sided);

    /// Samples a point; `u` in the unit square.
    [[nodiscard]] ExtentSample sample(const Vec3& from, const Vec2& u) const;
    [[nodiscard]] double area() const { return area_; }
    /// The centroid of the surface.
    [[nodiscard]] const Vec3& center() const { return center_; }
    /// The projected area along the unit `direction`, which runs towards the light; both sides
    /// count if it is two-sided. Meshes: the sum over their triangles, also of those that others
    /// hide; more than kMostTriangles are gathered by ranges of their normals.
    [[nodiscard]] double projected_area(const Vec3& direction) const;

  private:
    struct Place {
        Vec3 point, normal;
        double density;  ///< density by area
    };
    [[nodiscard]] ExtentSample seen(const Vec3& from, const Place& place) const;
    [[nodiscard]] ExtentSample on_sphere(const SphereExtent& s, const Vec3& from,
                                         const Vec2& u) const;
    [[nodiscard]] Place on_tube(const TubeExtent& t, const Vec3& from, const Vec2& u) const;
    [[nodiscard]] Place on_triangles(const Vec2& u) const;
    void set_triangles(const MeshExtent& mesh);
    void set_normal_areas();

    LightExtent extent_;
    bool two_sided_;
    double area_ = 0;
    Vec3 center_, normal_;  ///< normal: of flat extents
    /// Three corners per triangle, and the cumulative areas.
    std::vector<Vec3> corners_;
    std::vector<double> areas_;
    std::vector<Vec3> normal_areas_;  ///< mesh: normals times areas, of triangles or their sums
};

/// Describes what is wrong with the extent; null if nothing is.
[[nodiscard]] const char* fault_of(const LightExtent& extent);

/// Area-preserving map from the unit square to the unit disc.
[[nodiscard]] Vec2 on_unit_disc(const Vec2& u);
/// A direction in a cone around `axis`, uniform by solid angle. `versine`: 1 less the cosine of the
/// half angle.
[[nodiscard]] Vec3 direction_in_cone(const Vec3& axis, double versine, const Vec2& u);

}  // namespace alhazen
