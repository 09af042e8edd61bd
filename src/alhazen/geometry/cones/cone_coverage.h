#pragma once
/// How much of a cone a sphere, a plane, a polygon or a triangle covers, in closed form.
///
/// Source: Amanatides, "Ray Tracing with Cones", SIGGRAPH 1984, section 3; Tovchigrechko and
/// Vakser, "How Common Is the Funnel-Like Energy Landscape in Protein-Protein Interactions?",
/// Protein Science 10, 2001 (the area common to two caps of a sphere).
/// Differs: the text takes the section of the cone at the object for a flat one. Here flat things
/// are mapped to the disc of the cone by the projection from its apex, which is exact for every
/// angle and tilt; a sphere is the cap of its directions, exact too, and a circle of the
/// stereographic projection where the cone is narrow (below 0.02 radians, off by at most 5e-5).
/// Conventions: coverage is 0 to 1 of the disc (flat things), of the solid angle (spheres). Only
/// what lies at distances z_min to z_max along the centre line covers. The apex inside a sphere is
/// covered by it.
/// Complexity: O(1), O(edges); no allocation once the scratch has grown.

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "alhazen/geometry/cones/cone_map.h"
#include "alhazen/geometry/cones/disc_area.h"

namespace alhazen {

/// Distances along the centre line.
struct ConeRange {
    double z_min = 0, z_max = std::numeric_limits<double>::infinity();
};

/// The covered part of a cone: its share, and the point of the disc in its middle.
struct ConeCover {
    double share = 0;
    Vec2 at{0, 0};
};

/// Share of the cap of directions within `alpha` of one direction that is within `beta` of
/// another, `gamma` away. Radians; alpha in (0, pi / 2], beta in [0, pi].
[[nodiscard]] double cap_share(double alpha, double beta, double gamma);

/// A sphere in the stereographic projection of a cone: a circle in units of the radius of the
/// cone's. Kirk's tables are looked up with it.
struct SphereDisc {
    enum class Kind { None, All, Disc, HalfPlane, Cap };
    Kind kind = Kind::None;
    double radius = 0;           ///< of the disc
    double distance = 0;         ///< of its centre; of the half plane's edge
    Vec2 towards{1, 0};          ///< unit, to its centre
    double half_angle = 0;       ///< of the cone
    double scale = 0;            ///< tangent of half of `half_angle`
    double cap = 0, offset = 0;  ///< angles, for Kind::Cap
};
[[nodiscard]] SphereDisc sphere_disc(const ConeRay& cone, const ConeMap& map, const Vec3& center,
                                     double radius);
/// The point of the unit disc of a cone for one at `distance` in the stereographic projection.
[[nodiscard]] Vec2 disc_point(const SphereDisc& sphere, double distance);
/// Coverage by closed forms.
[[nodiscard]] ConeCover cover_of(const SphereDisc& sphere);

/// The plane through `point`; from both sides.
[[nodiscard]] ConeCover plane_cover(const ConeRay& cone, const Vec3& point, const Vec3& normal,
                                    const ConeRange& range = {});

/// Memory for `loop_cover`, kept from call to call.
struct ConeScratch {
    std::vector<ConePoint> a, b;
};
/// The signed part of the disc within a flat loop: negative where the front is seen, whose
/// corners run counter-clockwise for the viewer. Loops of one polygon add up: holes run the other
/// way round.
[[nodiscard]] DiscPart loop_cover(const ConeMap& map, std::span<const Vec3> loop,
                                  const ConeRange& range, ConeScratch& scratch);

/// A polygon with holes: `loop_ends` as in the shape Polygon; holes run the other way round.
[[nodiscard]] ConeCover polygon_cover(const ConeMap& map, std::span<const Vec3> vertices,
                                      std::span<const std::uint32_t> loop_ends,
                                      const ConeRange& range, ConeScratch& scratch,
                                      bool* front = nullptr);

/// A triangle of corners in the coordinates of the cone; `front`: whether its front is seen.
[[nodiscard]] ConeCover triangle_cover(const std::array<ConePoint, 3>& corners,
                                       const ConeRange& range, bool converges, bool& front);

/// The barycentric weights of the second and third corner where the line of the cone through
/// `at` of the disc meets the plane of a triangle, and the distance along the centre line.
struct TrianglePlace {
    double u = 0, v = 0, z = 0;
};
[[nodiscard]] TrianglePlace place_in_triangle(const std::array<ConePoint, 3>& corners,
                                              const Vec2& at);

}  // namespace alhazen
