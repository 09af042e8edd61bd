#pragma once
/// An emitting surface in world space, sampled as seen from a point or by area.
///
/// Source: Shirley, Wang and Zimmerman, "Monte Carlo Techniques for Direct Lighting Calculations",
/// ACM TOG 15(1), 1996 (the sphere by its cone, all others by area); spherical_polygons.h.
/// Differs: an affine image of a sphere is sampled in the cone of the sphere; the density follows
/// from the change of solid angle, |det A| / |A d|^3 for a unit d. The density of a transformed
/// disc or tube follows from the change of area.
/// From outside of an unseen sphere of two sides, either of its two points in a direction of the
/// cone is sampled, with the same probability.
/// Conventions: densities are by solid angle at the lit point. The choice between sampling by solid
/// angle and by area depends only on the point and the emitter, so that `density` can repeat it.
/// Complexity: O(1); O(log n) for a polygon of n triangles. Threads: const functions may be called
/// from many.

#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "alhazen/geometry/box.h"
#include "alhazen/geometry/ray.h"
#include "alhazen/illumination/spherical_polygons.h"
#include "alhazen/imaging/image/rgb.h"
#include "alhazen/math/affine.h"
#include "alhazen/shading/optics/illuminant.h"
#include "alhazen/shapes/patches/bezier_net.h"

namespace alhazen {

/// Emitters of a smaller solid angle are sampled by area: both densities are about equal there, and
/// the formulas of solid angles lose digits.
inline constexpr double kLeastSolidAngle = 1e-4;

struct EmittingPatch {
    BezierNet net;
    bool turned = false;  ///< the outer normal is -(du x dv)
};

/// The form of an emitter in its own frame. For flat forms the z_axis of `world_from_own` is the
/// unit outer normal.
enum class EmitterForm : std::uint8_t {
    Triangle,   ///< x, y >= 0, x + y <= 1
    Rectangle,  ///< x and y in 0..1: a parallelogram
    Disc,       ///< of radius 1 around the origin, with a hole of radius `inner`
    Polygon,    ///< the triangles of `parts`, all in one plane
    Sphere,     ///< of radius 1 around the origin
    Tube,       ///< of radius 1 around z, between z = 0 and 1
    Patch,      ///< `patch`
};

struct EmitterParts {
    std::vector<Vec3> corners;  ///< [triangle][3], in world space
    std::vector<double> areas;  ///< [triangle] cumulative, including it
};

/// What samples by area read comes first.
struct alignas(64) Emitter {
    EmitterForm form = EmitterForm::Triangle;
    bool two_sided = false;
    bool right_angled = false;  ///< Rectangle: its edges are perpendicular
    /// Sphere: no connection meets it, so that light of its inner side passes the rest of it.
    bool unseen = false;
    double area = 0;  ///< of one side; of curved forms by numerical integration
    /// Triangle, and Rectangle with perpendicular edges: from points whose squared distance to the
    /// origin of `world_from_own` is larger, its solid angle is below kLeastSolidAngle, or
    /// `prefer_area` was called.
    double far_squared = std::numeric_limits<double>::infinity();
    /// The same forms: nearer to its plane a point may lie in it, but for rounding. Sphere: as
    /// near to a point of it, in its own frame.
    double in_plane = -1;
    Affine world_from_own;
    Rgb radiance;      ///< mean over the surface
    double inner = 0;  ///< Disc: radius of the hole
    std::shared_ptr<const EmitterParts> parts;
    std::shared_ptr<const EmittingPatch> patch;
    std::optional<Illuminant> illuminant;  ///< its spectrum, if known
    RectangleSides sides;                  ///< Rectangle with perpendicular edges
};

/// Sets `area`, `right_angled`, `sides`, `far_squared` and `in_plane`. False if the area is 0 or
/// some value is not finite.
[[nodiscard]] bool make_ready(Emitter& emitter);

/// Samples a triangle, or a rectangle with perpendicular edges, by area from nearer points, too:
/// from eight times the sum of its edges away, where the density of samples by area varies by a few
/// percent. For many lights, which are sampled by area in lanes. Precondition: `make_ready`.
void prefer_area(Emitter& emitter);

/// True if a point is certain to be where the emitter is sampled by area: far away, or in its
/// plane, where rounding alone decides between a solid angle of 0 and of half of all directions.
[[nodiscard]] inline bool is_sampled_by_area(const Emitter& emitter, const Vec3& from) {
    const Vec3 offset = emitter.world_from_own.translation - from;
    return length_squared(offset) > emitter.far_squared ||
           std::abs(dot(offset, emitter.world_from_own.linear.z_axis)) <= emitter.in_plane;
}

/// A point of an emitter as seen from another point.
struct EmitterSample {
    Vec3 to_light;  ///< unit
    double distance = 0;
    double density = 0;  ///< by solid angle; 0: no light arrives
    Vec2 parameters;     ///< weights of a triangle's second and third corner; (u, v) of a patch
    double facing = 0;   ///< |cosine| at the emitter
};
/// Samples a point of the emitter as seen from `from`; `u` in [0, 1)^2.
[[nodiscard]] EmitterSample sample(const Emitter& emitter, const Vec3& from, const Vec2& u);

/// A triangle that emits: the corner and two edges from it, its unit outer normal, and the density
/// of samples by area.
struct EmittingTriangle {
    const Vec3 &corner, &x, &y, &normal;
    double density;
    bool two_sided;
};
/// `sample` of a triangle for a point where `is_sampled_by_area` is false.
[[nodiscard]] EmitterSample sample_near(const EmittingTriangle& emitter, const Vec3& from,
                                        const Vec2& u);

/// A point of an emitter that a ray hit.
struct EmitterHit {
    Vec3 direction;  ///< of the ray, unit
    double distance = 0;
    Vec3 normal;      ///< unit, outward
    Vec2 parameters;  ///< (u, v) of a patch
};
/// The density by solid angle of `sample(from)` for the direction of the hit.
[[nodiscard]] double density(const Emitter& emitter, const Vec3& from, const EmitterHit& hit);

/// A point of an emitter.
struct EmitterPoint {
    Vec3 point, normal;
    double density = 0;  ///< by area
    Vec2 parameters;
};
/// Samples a point of the emitter by area, of curved forms by their parameters; `u` in [0, 1)^2.
[[nodiscard]] EmitterPoint point_of(const Emitter& emitter, const Vec2& u);
/// The density by area of `point_of` for a point with this normal.
[[nodiscard]] double area_density(const Emitter& emitter, const Vec3& normal,
                                  const Vec2& parameters);

/// Bounds for the choice among many emitters (light_tree.h).
struct EmitterBounds {
    Box3 box;
    Vec3 center;               ///< of mass, or near it
    Vec3 axis{0, 0, 1};        ///< unit, of the cone of normals
    double cosine_spread = 1;  ///< cosine of the half angle of that cone; -1: all directions
};
[[nodiscard]] EmitterBounds bounds_of(const Emitter& emitter);

/// A bound of the rounding of points of an emitter within `box`, and of the tests that find them,
/// times the margin of LeavingRays: a patch's errs most (docs/design/secondary_rays.md).
[[nodiscard]] inline double rounding_within(const Box3& box) {
    return 0x1p-42 * std::max(max_component(abs(box.lo)), max_component(abs(box.hi)));
}
/// The same of the coordinates in a frame around the emitter, and of the way out of it. `box`: of
/// the emitter in world space.
[[nodiscard]] double rounding_within(const Affine& world_from_frame, const Box3& box);

/// The ray that leaves a point of an emitter along a unit direction, `away` from the surface.
[[nodiscard]] inline Ray leaving_ray(const EmitterPoint& p, const Vec3& direction, double away) {
    return {p.point + (dot(direction, p.normal) < 0.0 ? -away : away) * p.normal, direction};
}

}  // namespace alhazen
