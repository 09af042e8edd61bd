#pragma once
/// Coordinates in which a cone is the unit disc, so that coverage is an area in the plane.
///
/// Along every line of a cone (x, y) / w is constant, where x and y are distances across the centre
/// line and w is the radius of the cone there. The map is projective: straight edges stay straight,
/// so the part of a cone that a plane or a polygon covers is exact, even at grazing angles.
///
/// Conventions: all coordinates are affine functions of a point. z is the distance along the centre
/// line. A composed map takes points of another frame. x cross y points along z.

#include <array>

#include "alhazen/geometry/box.h"
#include "alhazen/geometry/cones/cone_ray.h"
#include "alhazen/math/affine.h"

namespace alhazen {

/// dot(g, p) + c.
struct AffineForm {
    Vec3 g;
    double c = 0;

    [[nodiscard]] double operator()(const Vec3& p) const { return dot(g, p) + c; }
    [[nodiscard]] AffineForm composed(const Affine& to_from) const {
        return {transpose_times(to_from.linear, g), dot(g, to_from.translation) + c};
    }
    /// The largest change from the centre of a box whose half extents are `half`.
    [[nodiscard]] double reach(const Vec3& half) const { return dot(abs(g), half); }
};

/// A point in the coordinates of a cone.
struct ConePoint {
    double x = 0, y = 0, w = 0, z = 0;
};

struct ConeMap {
    AffineForm x, y, w, z;
    bool converges = false;

    ConeMap() = default;
    explicit ConeMap(const ConeRay& cone) : converges(cone.spread < 0.0) {
        const Vec3 ex = perpendicular(cone.axis), ey = cross(cone.axis, ex);
        const auto from_origin = [&](const Vec3& g) { return AffineForm{g, -dot(g, cone.origin)}; };
        x = from_origin(ex);
        y = from_origin(ey);
        z = from_origin(cone.axis);
        w = {cone.spread * z.g, cone.spread * z.c + cone.radius};
    }

    [[nodiscard]] ConeMap composed(const Affine& to_from) const {
        ConeMap map;
        map.x = x.composed(to_from);
        map.y = y.composed(to_from);
        map.w = w.composed(to_from);
        map.z = z.composed(to_from);
        map.converges = converges;
        return map;
    }
    [[nodiscard]] ConePoint operator()(const Vec3& p) const { return {x(p), y(p), w(p), z(p)}; }
};

/// The least z of a box, and whether the cone may meet the box beyond `z_min`. Conservative: the
/// box counts as met unless the plane that touches the cone on the side of the box separates the
/// two.
struct ConeBoxTest {
    bool may_meet = false;
    double z = 0;
};
[[nodiscard]] inline ConeBoxTest test_box(const ConeMap& map, const Vec3& center, const Vec3& half,
                                          double z_min, double z_max) {
    const double zc = map.z(center), z_reach = map.z.reach(half);
    ConeBoxTest test{false, zc - z_reach};
    if (!(zc + z_reach >= z_min) || !(test.z <= z_max)) return test;
    const double xc = map.x(center), yc = map.y(center), wc = map.w(center);
    const double across = std::sqrt(xc * xc + yc * yc);
    test.may_meet = true;
    if (!(across > 0.0)) return test;
    const double nx = xc / across, ny = yc / across;
    const Vec3 g = nx * map.x.g + ny * map.y.g;
    // The distance of the box beyond the plane n (x, y) = w, which touches the cone where w >= 0.
    const double slack = 1e-9 * (across + std::abs(wc) + z_reach);
    const double ahead = across - wc - AffineForm{g - map.w.g, 0}.reach(half);
    if (!(ahead > slack)) return test;
    if (!map.converges) {
        test.may_meet = false;
        return test;
    }
    const double beyond = across + wc - AffineForm{g + map.w.g, 0}.reach(half);
    test.may_meet = !(beyond > slack);
    return test;
}

}  // namespace alhazen
