#pragma once
/// Numeric helpers of the shapes: rounding bounds, accurate vectors, checks of fields, writing of
/// hits.
///
/// Source: Higham, "Accuracy and Stability of Numerical Algorithms", 2nd ed., SIAM, 2002, section
/// 3.1 (gamma); Pharr, Jakob and Humphreys, "Physically Based Rendering", 4th ed., section 6.8
/// (error bounds of surface points).
/// Conventions: internal to shapes/.

#include <cmath>
#include <limits>
#include <string>

#include "alhazen/base/number_text.h"
#include "alhazen/math/constants.h"
#include "alhazen/math/quadratic.h"
#include "alhazen/math/unit_vector.h"
#include "alhazen/shapes/core/shape.h"

namespace alhazen {

/// Relative error bound of n consecutive roundings.
constexpr double gamma_bound(int n) {
    constexpr double kHalfUlp = 0x1p-53;
    return n * kHalfUlp / (1.0 - n * kHalfUlp);
}

/// Limit of the magnitude of coordinates and, by its inverse, of lengths: squares and products of
/// four neither overflow nor underflow.
inline constexpr double kMaxCoordinate = 1e70;
inline constexpr double kMinLength = 1e-70;

/// True if a solid with a face of this outward normal keeps the lines that lie in the face: as if
/// lines were moved by (-e, -e^2, -e^3) for an infinitesimal e > 0. Between solids that touch in a
/// face there is then neither gap nor overlap. In a mirrored or turned placement the frame is that
/// of the solid.
///
/// Source: Edelsbrunner and Mücke, "Simulation of Simplicity", ACM Transactions on Graphics 9(1),
/// 1990.
inline bool keeps_face(const Vec3& outward) {
    for (int k = 0; k < 3; ++k) {
        if (outward[k] != 0.0) return outward[k] > 0.0;
    }
    return false;
}

/// Cross product, each component within 1.5 ulp, also for nearly parallel vectors.
inline Vec3 accurate_cross(const Vec3& a, const Vec3& b) {
    return {difference_of_products(a.y, b.z, a.z, b.y), difference_of_products(a.z, b.x, a.x, b.z),
            difference_of_products(a.x, b.y, a.y, b.x)};
}

/// Half the size of a circle's box: `radius` times the sine of the angle between `n` (unit) and
/// each axis, without the cancellation in 1 - n^2.
inline Vec3 circle_half_box(const Vec3& n, double radius) {
    return radius * Vec3{std::hypot(n.y, n.z), std::hypot(n.z, n.x), std::hypot(n.x, n.y)};
}

/// center +- half, rounded outward.
inline Box3 outward_box(const Vec3& center, const Vec3& half) {
    const Vec3 padded_half = half + gamma_bound(16) * (abs(center) + half);
    return {center - padded_half, center + padded_half};
}

/// Range of dot(axis, p) for a shape whose extent along `axis` is `half` on each side of `center`,
/// rounded outward.
inline Interval outward_extent(const Vec3& axis, const Vec3& center, double half) {
    const double middle = dot(axis, center);
    const double reach = half + gamma_bound(16) * (dot(abs(axis), abs(center)) + half);
    return {middle - reach, middle + reach};
}

/// The angle of (x, y) as a fraction of the circle, in [0, 1).
inline double turn_fraction(double x, double y) {
    const double turn = std::atan2(y, x) / (2.0 * kPi);
    if (turn >= 0.0) return turn;
    const double wrapped = turn + 1.0;
    return wrapped < 1.0 ? wrapped : 0.0;
}

// ---- writing hits

/// Writes the crossing if t lies in the ray's range; returns the number written.
inline int report_crossing(const Ray& ray, const ShapeHit& hit, ShapeHit* hits) {
    if (!ray.covers(hit.t) || !std::isfinite(hit.t)) return 0;
    hits[0] = hit;
    return 1;
}

/// Writes the ends of a span entry <= exit that lie in the ray's range. A span with an infinite end
/// counts as none.
inline int report_span(const Ray& ray, double entry, std::uint32_t entry_part, double exit,
                       std::uint32_t exit_part, ShapeHit* hits) {
    if (!(entry <= exit) || !std::isfinite(entry) || !std::isfinite(exit)) return 0;
    int count = 0;
    if (ray.covers(entry)) hits[count++] = {entry, 0, 0, entry_part};
    if (ray.covers(exit)) hits[count++] = {exit, 0, 0, exit_part};
    return count;
}

// ---- planes

/// t of the crossing with a plane; infinite when the ray is parallel to it.
inline double plane_crossing(const Ray& ray, const Vec3& point, const Vec3& unit_normal) {
    const double slope = dot(unit_normal, ray.direction);
    return slope == 0.0 ? kInfinity : dot(unit_normal, point - ray.origin) / slope;
}

/// `p` projected to the plane through `point`, with its error; the caller sets uv.
inline ShapeSurface surface_on_plane(const Vec3& p, const Vec3& point, const Vec3& unit_normal) {
    ShapeSurface surface;
    const Vec3 from_point = p - point;
    surface.point = p - dot(unit_normal, from_point) * unit_normal;
    surface.normal = surface.shading_normal = unit_normal;
    // Seven roundings of the offset's terms (three of them in the normal), one of the result.
    const Vec3 n = abs(unit_normal);
    const double distance =
        gamma_bound(10) * dot(n, abs(from_point)) + gamma_bound(2) * dot(n, abs(surface.point));
    surface.error = distance * n;
    return surface;
}

// ---- validation

/// Reports "NAME: FIELD ..." for each invalid field.
class FieldChecks {
  public:
    FieldChecks(const char* shape, const FileLocation& where, Diagnostics& diagnostics)
        : shape_(shape), where_(where), diagnostics_(diagnostics) {}

    void fail(const std::string& what) {
        diagnostics_.error(where_, std::string(shape_) + ": " + what);
        ok_ = false;
    }
    void point(const char* field, const Vec3& p) {
        if (!(max_component(abs(p)) <= kMaxCoordinate) || !is_finite(p)) {
            fail(std::string(field) + " must be three finite numbers below 1e70");
        }
    }
    /// `least` is kMinLength, or 0 where a length may be zero.
    void length(const char* field, double value, double least = kMinLength) {
        const bool usable = value == 0.0 ? least == 0.0 : value >= kMinLength;
        if (!usable || !(value <= kMaxCoordinate)) {
            fail(std::string(field) + " must be a number " +
                 (least == 0.0 ? "that is zero or " : "") + "from 1e-70 to 1e70, not " +
                 shortest(value));
        }
    }
    void vector(const char* field, const Vec3& v) {
        point(field, v);
        if (!(max_component(abs(v)) >= kMinLength)) {
            fail(std::string(field) + " must not be zero");
        }
    }
    [[nodiscard]] bool ok() const { return ok_; }

    /// Tests each field as declared (fields.h), in order; skips those of Check::Shape.
    template <class S>
    void fields(const S& shape) {
        for_each_field<S>(
            [&](const auto& field) { test(field.name, shape.*field.member, field.check); });
    }

  private:
    void test(const char* field, const Vec3& value, Check check) {
        if (check == Check::Point) point(field, value);
        if (check == Check::Vector) vector(field, value);
    }
    void test(const char* field, double value, Check check) {
        if (check == Check::Length) length(field, value);
        if (check == Check::LengthOrZero) length(field, value, 0.0);
    }
    template <class T>
    void test(const char*, const T&, Check) {}

    const char* shape_;
    const FileLocation& where_;
    Diagnostics& diagnostics_;
    bool ok_ = true;
};

}  // namespace alhazen
