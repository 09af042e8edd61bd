#pragma once
/// A surface that shines, in world space: points of it chosen at random as seen from a point, or by
/// area.
///
/// Source: Shirley, Wang and Zimmerman, "Monte Carlo Techniques for Direct Lighting Calculations",
/// ACM TOG 15(1), 1996 (the sphere by its cone, all others by area); spherical_polygons.h.
/// Differs: what an affine transform makes of a sphere is sampled in the cone of the sphere, and
/// the density follows by the change of solid angle, |det A| / |A d|^3 for a unit d; that of a disc
/// or a tube by the change of area.
/// Conventions: densities are by solid angle at the point that is lit. Whether a form is sampled by
/// solid angle or by area depends on the point and the emitter alone, so that `density` knows it.
/// Complexity: O(1); O(log n) for a polygon of n triangles. Threads: const functions may be called
/// from many.

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "alhazen/geometry/box.h"
#include "alhazen/illumination/spherical_polygons.h"
#include "alhazen/imaging/image/rgb.h"
#include "alhazen/math/affine.h"
#include "alhazen/shading/optics/illuminant.h"
#include "alhazen/shapes/patches/bezier_net.h"

namespace alhazen {

/// What is seen under a smaller solid angle is sampled by area: there both are alike, and the
/// formulas of solid angles lose digits.
inline constexpr double kLeastSolidAngle = 1e-4;

struct EmittingPatch {
    BezierNet net;
    bool turned = false;  ///< the outer side is that of -(du x dv)
};

/// In its own frame; z_axis of `world_from_own` is the unit outer normal of what is flat.
enum class EmitterForm : std::uint8_t {
    Triangle,   ///< x, y >= 0, x + y <= 1
    Rectangle,  ///< x and y in 0..1: a parallelogram
    Disc,       ///< of radius 1 around the origin, with a hole of radius `inner`
    Polygon,    ///< triangles of `parts`, which lie in one plane
    Sphere,     ///< of radius 1 around the origin
    Tube,       ///< of radius 1 around z, between z = 0 and 1
    Patch,      ///< `patch`
};

struct EmitterParts {
    std::vector<Vec3> corners;  ///< [triangle][3], in world space
    std::vector<double> areas;  ///< [triangle] of all up to and with it
};

struct Emitter {
    EmitterForm form = EmitterForm::Triangle;
    bool two_sided = false;
    bool right_angled = false;  ///< of a rectangle
    RectangleSides sides;       ///< of one with right angles
    Affine world_from_own;
    double inner = 0;
    double area = 0;  ///< of one side; of what is curved by numerical integration
    Rgb radiance;     ///< its mean
    std::optional<Illuminant> illuminant;  ///< its spectrum, where known
    std::shared_ptr<const EmitterParts> parts;
    std::shared_ptr<const EmittingPatch> patch;
};

/// What emitters of the form have in common is set: area, and of a rectangle whether its angles are
/// right. False: it has no area, or it is not finite.
[[nodiscard]] bool make_ready(Emitter& emitter);

/// A point of an emitter as seen from another.
struct EmitterSample {
    Vec3 to_light;  ///< unit
    double distance = 0;
    double density = 0;  ///< by solid angle; 0: nothing comes from there
    Vec2 parameters;     ///< of a triangle the weights of its second and third corner; of a patch
};
/// `u` in [0, 1)^2.
[[nodiscard]] EmitterSample sample(const Emitter& emitter, const Vec3& from, const Vec2& u);

/// A point of an emitter that a ray hit.
struct EmitterHit {
    Vec3 direction;  ///< of the ray, unit
    double distance = 0;
    Vec3 normal;      ///< unit, outward
    Vec2 parameters;  ///< of a patch
};
/// With which `sample(from)` gives that direction.
[[nodiscard]] double density(const Emitter& emitter, const Vec3& from, const EmitterHit& hit);

/// A point of the emitter.
struct EmitterPoint {
    Vec3 point, normal;
    double density = 0;  ///< by area
    Vec2 parameters;
};
/// Chosen by area; of what is curved, by its parameters.
[[nodiscard]] EmitterPoint point_of(const Emitter& emitter, const Vec2& u);
/// By area, with which `point_of` gives a point with this normal.
[[nodiscard]] double area_density(const Emitter& emitter, const Vec3& normal,
                                  const Vec2& parameters);

/// Bounds for the choice among many (light_tree.h).
struct EmitterBounds {
    Box3 box;
    Vec3 axis{0, 0, 1};        ///< of the cone of its normals, unit
    double cosine_spread = 1;  ///< of half the angle of that cone; -1: all directions
};
[[nodiscard]] EmitterBounds bounds_of(const Emitter& emitter);

}  // namespace alhazen
