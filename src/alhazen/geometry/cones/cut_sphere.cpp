#include "alhazen/geometry/cones/cut_sphere.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "alhazen/base/inline_vector.h"
#include "alhazen/math/constants.h"

namespace alhazen {

namespace {

constexpr std::size_t kConeArcSides = 48;
using ConeOutline = InlineVector<Vec3, 2 * kConeArcSides + 2>;

/// An arc around the direction `u`.
struct ConeArc {
    Vec3 center, u, v;
    double radius, half_angle;

    /// Adds points with angles from -half_angle to half_angle, or back. Those in between lie
    /// outside the arc, so that the area is that of the arc.
    void add_to(ConeOutline& outline, bool back) const {
        const double step = 2.0 * half_angle / kConeArcSides;
        const bool whole = half_angle >= kPi;
        const double beyond = radius * std::sqrt(step > 0.0 ? step / std::sin(step) : 1.0);
        for (std::size_t k = 0; k < (whole ? kConeArcSides : kConeArcSides + 1); ++k) {
            const double angle = (back ? -1.0 : 1.0) * (static_cast<double>(k) * step - half_angle);
            const double r = whole || (k > 0 && k < kConeArcSides) ? beyond : radius;
            outline.push_back(center + r * (std::cos(angle) * u + std::sin(angle) * v));
        }
    }
};

/// Half of the angle for which sum + scale cos(angle) >= 0.
double half_angle_of(double sum, double scale) {
    if (!(scale > 0.0)) return sum >= 0.0 ? kPi : 0.0;
    return std::acos(std::clamp(-sum / scale, -1.0, 1.0));
}

ConeCover outline_cover(const ConeOutline& outline, const ConeMap& map, double z_max,
                        ConeScratch& scratch) {
    if (outline.empty()) return {};
    return polygon_cover(map, {outline.begin(), outline.size()}, {}, {-kInfinity, z_max}, scratch);
}

}  // namespace

bool is_cut(const ConeSphere& sphere, const ConePlane& start) {
    constexpr double kAlmost = 1.0 - 1e-6;
    return std::abs(dot(sphere.center - start.point, start.normal)) < kAlmost * sphere.radius;
}

std::optional<ConeCover> cut_cover(const ConeRay& cone, const ConeMap& map,
                                   const ConeSphere& sphere, const ConePlane& start,
                                   const ConeCover& whole, double z_max, ConeScratch& scratch) {
    const Vec3& n = start.normal;
    const double R = sphere.radius, h = dot(sphere.center - start.point, n);
    // A line that leaves q on the sphere leaves the sphere, too, if dot(d, q - center) >= least.
    Vec3 d = cone.axis;
    double least = 0.0;
    if (cone.spread != 0.0) {
        const double side = cone.spread < 0.0 ? 1.0 : -1.0;
        d = side * (cone.apex() - sphere.center);
        least = side * R * R;
    }
    Vec3 e = d - dot(d, n) * n;
    const double in_plane = length(e);
    e = in_plane > 1e-9 * length(d) ? e / in_plane : perpendicular(n);
    const Vec3 f = cross(n, e);
    ConeArc circle{sphere.center - h * n, e, f, std::sqrt(std::max((R - h) * (R + h), 0.0)), kPi};
    ConeOutline outline;
    circle.add_to(outline, false);
    const ConeCover lost = outline_cover(outline, map, z_max, scratch);
    if (!(lost.share < 1.0 - 1e-6)) return std::nullopt;
    circle.half_angle = half_angle_of(-h * dot(d, n) - least, circle.radius * in_plane);
    // The contour of the sphere, as the lines see it.
    const double dd = length_squared(d), along = least / dd;
    const double contour = R * R - along * least;
    ConeCover covered = whole;
    if (contour > 0.0) {
        const Vec3 up = n - (dot(n, d) / dd) * d;
        const double steep = length(up);
        const Vec3 u = steep > 1e-9 ? up / steep : -e;
        ConeArc arc{sphere.center + along * d, u, f, std::sqrt(contour), kPi};
        arc.half_angle = half_angle_of(h + along * dot(d, n), arc.radius * dot(u, n));
        if (!(arc.half_angle > 0.0)) return ConeCover{};
        if (arc.half_angle < kPi) {
            outline.clear();
            arc.add_to(outline, false);
            circle.add_to(outline, true);
            covered = outline_cover(outline, map, z_max, scratch);
        }
    } else if (cone.spread > 0.0) {
        return ConeCover{};
    }
    const double share = covered.share - lost.share;
    if (!(share > 0.0)) return ConeCover{};
    const Vec2 at = (1.0 / share) * (covered.share * covered.at - lost.share * lost.at);
    const double off = std::sqrt(at.x * at.x + at.y * at.y);
    return ConeCover{share / (1.0 - lost.share), (1.0 / std::max(off, 1.0)) * at};
}

}  // namespace alhazen
