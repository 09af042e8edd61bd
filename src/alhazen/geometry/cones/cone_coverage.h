#pragma once
/// The part of a cone that a sphere, a plane, a polygon or a triangle covers, in closed form.
///
/// Source: Amanatides, "Ray Tracing with Cones", SIGGRAPH 1984, section 3; Tovchigrechko and
/// Vakser, "How Common Is the Funnel-Like Energy Landscape in Protein-Protein Interactions?",
/// Protein Science 10, 2001 (the area common to two caps of a sphere).
/// Differs: the text treats the section of the cone at the object as flat. Here flat shapes are
/// mapped to the disc of the cone by the projection from its apex, which is exact for every angle
/// and tilt. A sphere is the cap of its directions, also exact, and a circle of the stereographic
/// projection if the cone is narrow (below 0.02 radians, with an error of at most 5e-5).
/// Conventions: coverage is a part, 0 to 1, of the disc (flat shapes) or of the solid angle
/// (spheres). Only points at distances z_min to z_max along the centre line cover. A sphere covers
/// the whole cone if the apex is inside.
/// Complexity: O(1), or O(edges) for polygons; no allocation once the scratch memory has grown.

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "alhazen/geometry/cones/cone_map.h"
#include "alhazen/geometry/cones/disc_area.h"

namespace alhazen {

/// A range of distances along the centre line.
struct ConeRange {
    double z_min = 0, z_max = std::numeric_limits<double>::infinity();
};

/// The covered part of a cone: its share of the cone, 0 to 1, and the point of the disc at its
/// centroid.
struct ConeCover {
    double share = 0;
    Vec2 at{0, 0};
};

/// The part of the cap of directions within `alpha` of one direction that lies within `beta` of
/// another, at the angle `gamma` from the first. Radians; alpha in (0, pi / 2], beta in [0, pi].
[[nodiscard]] double cap_share(double alpha, double beta, double gamma);

/// A sphere in the stereographic projection of a cone: a circle, in units of the radius of the
/// cone's circle. The argument of Kirk's tables (coverage_tables.h).
struct SphereDisc {
    enum class Kind { None, All, Disc, HalfPlane, Cap };
    Kind kind = Kind::None;
    double radius = 0;           ///< of the disc
    double distance = 0;         ///< of the disc's centre, or of the half plane's edge
    Vec2 towards{1, 0};          ///< unit vector to the disc's centre
    double half_angle = 0;       ///< of the cone, in radians
    double scale = 0;            ///< tangent of half of `half_angle`
    double cap = 0, offset = 0;  ///< radius, angle to the centre, for Kind::Cap
};
[[nodiscard]] SphereDisc sphere_disc(const ConeRay& cone, const ConeMap& map, const Vec3& center,
                                     double radius);
/// The point of the unit disc of a cone for a point at `distance` in the stereographic projection.
[[nodiscard]] Vec2 disc_point(const SphereDisc& sphere, double distance);
/// The coverage by a sphere, by closed forms.
[[nodiscard]] ConeCover cover_of(const SphereDisc& sphere);

/// The coverage by the plane through `point`, seen from either side.
[[nodiscard]] ConeCover plane_cover(const ConeRay& cone, const Vec3& point, const Vec3& normal,
                                    const ConeRange& range = {});

/// Scratch memory for `loop_cover`, reused between calls.
struct ConeScratch {
    std::vector<ConePoint> a, b;
};
/// The signed part of the disc within a flat loop: negative if the front is seen, the side from
/// which the corners run counter-clockwise. The loops of a polygon add up: holes run the other way.
[[nodiscard]] DiscPart loop_cover(const ConeMap& map, std::span<const Vec3> loop,
                                  const ConeRange& range, ConeScratch& scratch);

/// The coverage by a polygon with holes: `loop_ends` as in the shape Polygon; holes run the other
/// way.
[[nodiscard]] ConeCover polygon_cover(const ConeMap& map, std::span<const Vec3> vertices,
                                      std::span<const std::uint32_t> loop_ends,
                                      const ConeRange& range, ConeScratch& scratch,
                                      bool* front = nullptr);

/// The coverage by a triangle with corners in the coordinates of the cone. Sets `front` if its
/// front is seen.
[[nodiscard]] ConeCover triangle_cover(const std::array<ConePoint, 3>& corners,
                                       const ConeRange& range, bool converges, bool& front);

/// The point where the line of the cone through `at` on the disc meets the plane of a triangle:
/// barycentric weights of the second and third corner, and distance along the centre line.
struct TrianglePlace {
    double u = 0, v = 0, z = 0;
};
[[nodiscard]] TrianglePlace place_in_triangle(const std::array<ConePoint, 3>& corners,
                                              const Vec2& at);

}  // namespace alhazen
