#pragma once
/// Surfaces of lights with extent, and points on them that are chosen at random.
///
/// Source: Shirley and Chiu, "A Low Distortion Map Between Disk and Square", JGT 2(3), 1997 (discs,
/// cones); Shirley, Wang and Zimmerman, "Monte Carlo Techniques for Direct Lighting Calculations",
/// ACM TOG 15(1), 1996 (the sphere by its cone, polygons by area); Turk, "Generating Random Points
/// in Triangles", in Graphics Gems, 1990.
/// Differs: of a tube only the half that faces the point is sampled.
/// Conventions: densities are by solid angle at the point that is lit, so that they can be weighed
/// against those of other strategies. Spheres are sampled uniformly by solid angle, all others by
/// area. The outer side is that of the normal: of a rectangle edge_u x edge_v, of polygons and
/// triangles the side from which they run anticlockwise.
/// Complexity: O(1); O(log n) for n triangles. Threads: const functions may be called from many.

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
/// The side of a cylinder, without caps.
struct TubeExtent {
    Vec3 base, top{0, 0, 1};
    double radius = 0.05;
    friend bool operator==(const TubeExtent&, const TubeExtent&) = default;
};
/// Planar, of one loop.
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

/// A point of a light as seen from a point that it lights.
struct ExtentSample {
    Vec3 to_light;  ///< unit
    Vec3 normal;    ///< unit, of the outer side
    double distance = 0;
    double density = 0;  ///< by solid angle; 0: the point is not lit from there
};

/// An extent ready for sampling.
class LightSurface {
  public:
    LightSurface(const LightExtent& extent, bool two_sided);

    /// `u` in the unit square.
    [[nodiscard]] ExtentSample sample(const Vec3& from, const Vec2& u) const;
    [[nodiscard]] double area() const { return area_; }
    /// The mean of its points.
    [[nodiscard]] const Vec3& center() const { return center_; }
    /// The area of its outline seen along the unit `direction`, which runs towards the light; both
    /// sides count where it is two-sided. Of a mesh the mean over all directions, as if convex.
    [[nodiscard]] double projected_area(const Vec3& direction) const;

  private:
    struct Place {
        Vec3 point, normal;
        double density;  ///< by area
    };
    [[nodiscard]] ExtentSample seen(const Vec3& from, const Place& place) const;
    [[nodiscard]] ExtentSample on_sphere(const SphereExtent& s, const Vec3& from,
                                         const Vec2& u) const;
    [[nodiscard]] Place on_tube(const TubeExtent& t, const Vec3& from, const Vec2& u) const;
    [[nodiscard]] Place on_triangles(const Vec2& u) const;
    void set_triangles(const MeshExtent& mesh);

    LightExtent extent_;
    bool two_sided_;
    double area_ = 0;
    Vec3 center_, normal_;  ///< of what is flat
    /// Three corners of each triangle, and the areas of all up to and with it.
    std::vector<Vec3> corners_;
    std::vector<double> areas_;
};

/// What is wrong with it; null where nothing is.
[[nodiscard]] const char* fault_of(const LightExtent& extent);

/// The point of the unit disc for one of the unit square, by area.
[[nodiscard]] Vec2 on_unit_disc(const Vec2& u);

}  // namespace alhazen
