#pragma once
/// A profile of lines and cubic curves rotated about the z axis.
///
/// Source: Kajiya, "New Techniques for Ray Tracing Procedurally Defined Objects", SIGGRAPH 1983
/// (surfaces of revolution as curves of degree six in the parameter of the profile).
/// Differs: the crossings are the sign changes of that polynomial, isolated with certainty
/// (math/bernstein_roots.h); its signs at the ends of curves are those of the points there. t and
/// the parameter are then refined together (Newton in two variables). For a nearly level ray t
/// depends on the last digits of the parameter; such rays are traced by
/// shapes/swept/lathe_near_level.h. A level ray crosses where the profile has its height, at two
/// points of a circle.
/// Conventions: the profile lies in the half plane of (radius, height), radius >= 0; the solid is
/// the odd-even inside of its loops; a loop that begins and ends on the axis is completed by the
/// axis. Any other open loop makes a surface, not a solid. part = curve; u runs around the axis (0
/// to 1), v along all curves (0 to 1).
/// Complexity: O(curves) per ray.

#include "alhazen/shapes/core/shape.h"
#include "alhazen/shapes/swept/profile.h"

namespace alhazen {

struct Lathe {
    static constexpr const char* kName = "lathe";
    static constexpr int kMaxHits = kManyHits;
    static constexpr bool kClosed = true;

    Profile profile{};  ///< x is the distance from the axis, y the height

    bool is_closed = false;  ///< derived: bounds a volume
    double reach = 0;        ///< derived: largest coordinate of the profile
    Vec3 center{};           ///< derived: of the axis
    double radius = 1;       ///< derived: of a sphere about the center that contains the lathe

    static constexpr auto kFields =
        std::make_tuple(field("profile", &Lathe::profile, Unit::Compound, Check::Shape));

    void prepare();
    void validate(const FileLocation& where, Diagnostics& diagnostics) const;
    [[nodiscard]] bool closed() const;
    [[nodiscard]] Box3 box() const;
    [[nodiscard]] Interval extent(const Vec3& axis) const;
    void intersect(const Ray& ray, ShapeHits& hits) const;
    [[nodiscard]] ShapeSurface surface(const Ray& ray, const ShapeHit& hit) const;
};

}  // namespace alhazen
