#pragma once
/// Helpers of exact solids: a local frame in which the equation is simple, the convex region that
/// clips them, and the output of their crossings with the right parity.
///
/// Source: Roth, "Ray casting for modeling solids", Computer Graphics and Image Processing 18, 1982
/// (a solid as the intersection of intervals).
/// Differs: whether the line is inside where it enters the clip determines the caps, so the number
/// of crossings is even by construction.
/// Conventions: internal to shapes/. Numbers are double or double-double: in double-double the
/// transform of a ray is exact to 30 digits, and the doubles of `SolidFrame` define the shape.

#include "alhazen/geometry/bounds_source.h"
#include "alhazen/math/double_double.h"
#include "alhazen/shapes/core/shape_numerics.h"

namespace alhazen {

template <class Real>
struct Point3 {
    Real x{}, y{}, z{};
};

template <class Real>
inline Point3<Real> to_real(const Vec3& v) {
    return {Real(v.x), Real(v.y), Real(v.z)};
}

/// local = local_from_object * (p - origin).
struct SolidFrame {
    Vec3 origin{};
    Mat3 object_from_local, local_from_object;
    double stretch = 1;  ///< largest sum of magnitudes of a row of local_from_object

    SolidFrame() = default;
    SolidFrame(const Vec3& at, const Mat3& axes)
        : origin(at), object_from_local(axes), local_from_object(inverse(axes)) {
        stretch = max_component(abs(local_from_object.x_axis) + abs(local_from_object.y_axis) +
                                abs(local_from_object.z_axis));
    }

    template <class Real>
    [[nodiscard]] Point3<Real> local_vector(const Point3<Real>& v) const {
        const Mat3& m = local_from_object;
        const auto row = [&](double a, double b, double c) {
            return Real(a) * v.x + Real(b) * v.y + Real(c) * v.z;
        };
        return {row(m.x_axis.x, m.y_axis.x, m.z_axis.x), row(m.x_axis.y, m.y_axis.y, m.z_axis.y),
                row(m.x_axis.z, m.y_axis.z, m.z_axis.z)};
    }
    template <class Real>
    [[nodiscard]] Point3<Real> local_point(const Point3<Real>& p) const {
        return local_vector(
            Point3<Real>{p.x - Real(origin.x), p.y - Real(origin.y), p.z - Real(origin.z)});
    }
    /// The direction in the object of increasing local coordinate `k`, as a normal.
    [[nodiscard]] Vec3 normal_of(int k) const {
        const Mat3& m = local_from_object;
        return {m.x_axis[k], m.y_axis[k], m.z_axis[k]};
    }
    [[nodiscard]] Vec3 to_local(const Vec3& p) const { return local_from_object * (p - origin); }
    [[nodiscard]] Vec3 to_object(const Vec3& p) const { return object_from_local * p + origin; }
    /// Rounding of `to_object`, per component.
    [[nodiscard]] Vec3 object_error(const Vec3& p, int roundings) const {
        const Mat3& m = object_from_local;
        return gamma_bound(roundings) *
               (std::abs(p.x) * abs(m.x_axis) + std::abs(p.y) * abs(m.y_axis) +
                std::abs(p.z) * abs(m.z_axis) + abs(origin));
    }
};

/// The ray with its origin moved to t = shift, within an ulp of the new origin for any distance of
/// the old one. A crossing at t of the result is at shift + t of `ray`.
inline Ray advanced(const Ray& ray, double shift) {
    Ray moved = ray;
    for (int k = 0; k < 3; ++k) {
        const DoubleDouble way = two_product(shift, ray.direction[k]);
        const DoubleDouble sum = two_sum(ray.origin[k], way.high);
        moved.origin[k] = sum.high + (sum.low + way.low);
    }
    return moved;
}

/// A closed half space: dot(normal, p) <= offset.
struct ClipPlane {
    Vec3 normal{0, 0, 1};
    double offset = 0;
    friend bool operator==(const ClipPlane&, const ClipPlane&) = default;
};

/// The part of a line within a clip, and the faces where it enters and leaves.
struct ClipRange {
    double entry = -kInfinity, exit = kInfinity;
    std::uint32_t entry_part = 0, exit_part = 0;

    /// Cuts the range to where o + t d lies between lo and hi; returns false when it is empty. The
    /// sign of d selects the entry face; `outward`, the normal of the face at hi in the object,
    /// where a line in the plane of a face is (`keeps_face`).
    bool cut(double o, double d, double lo, double hi, std::uint32_t lo_part, const Vec3& outward) {
        if (d == 0.0) return keeps_face(outward) ? lo < o && o <= hi : lo <= o && o < hi;
        const double near = ((d > 0.0 ? lo : hi) - o) / d;
        const double far = ((d > 0.0 ? hi : lo) - o) / d;
        // A face without a finite t.
        if (!std::isfinite(near) && std::isfinite(d > 0.0 ? lo : hi)) return false;
        if (!std::isfinite(far) && std::isfinite(d > 0.0 ? hi : lo)) return false;
        if (near > entry) {
            entry = near;
            entry_part = d > 0.0 ? lo_part : lo_part + 1;
        }
        if (far < exit) {
            exit = far;
            exit_part = d > 0.0 ? lo_part + 1 : lo_part;
        }
        return entry < exit;
    }
};

/// Part numbers: 0 the surface itself, 1 to 6 the faces -x +x -y +y -z +z of the clip's box, 7 and
/// above its planes.
inline constexpr std::uint32_t kFirstClipPlanePart = 7;

/// Cuts the line by a box in the frame of the clip.
inline bool cut_by_box(const SolidFrame& frame, const Vec3& o, const Vec3& d, const Box3& box,
                       ClipRange& range) {
    return range.cut(o.x, d.x, box.lo.x, box.hi.x, 1, frame.normal_of(0)) &&
           range.cut(o.y, d.y, box.lo.y, box.hi.y, 3, frame.normal_of(1)) &&
           range.cut(o.z, d.z, box.lo.z, box.hi.z, 5, frame.normal_of(2));
}

/// Writes the crossings of a clipped solid. `t`, ascending and within the range, are where the line
/// enters and leaves the unclipped solid; `inside`: whether the line is in it at the range's entry.
inline int report_solid(const Ray& ray, const ClipRange& range, bool inside, const double* t,
                        int count, bool capped, ShapeHit* hits) {
    int written = 0;
    if (inside && capped) {
        written += report_crossing(ray, {range.entry, 0, 0, range.entry_part}, hits + written);
    }
    for (int i = 0; i < count; ++i) {
        written += report_crossing(ray, {t[i], 0, 0, 0}, hits + written);
    }
    if ((inside != (count % 2 != 0)) && capped) {
        written += report_crossing(ray, {range.exit, 0, 0, range.exit_part}, hits + written);
    }
    return written;
}

/// Texture coordinates as functions of a point in the frame: values and gradients.
struct LocalUv {
    Vec2 uv;
    Vec3 u_gradient, v_gradient;
};

/// Sets uv, dpdu and dpdv: the steps within the tangent plane that change one of u and v by one and
/// leave the other constant. They are zero where undefined, and where the surface is too steep in u
/// and v: sine of the angle below `least_slope`.
inline void set_uv(const SolidFrame& frame, const LocalUv& local, const Vec3& local_normal,
                   ShapeSurface& surface, double least_slope = 0.0) {
    surface.uv = local.uv;
    const double volume = dot(local_normal, cross(local.u_gradient, local.v_gradient));
    if (volume == 0.0 || !std::isfinite(volume)) return;
    if (least_slope > 0.0 &&
        !(std::abs(volume) >= least_slope * length(local_normal) * length(local.u_gradient) *
                                  length(local.v_gradient))) {
        return;
    }
    const Vec3 u_step = cross(local.v_gradient, local_normal) / volume;
    const Vec3 v_step = cross(local_normal, local.u_gradient) / volume;
    if (!is_finite(u_step) || !is_finite(v_step)) return;
    surface.dpdu = frame.object_from_local * u_step;
    surface.dpdv = frame.object_from_local * v_step;
}

/// u around the z axis from +x (0 to 1) and its gradient; (1, 0, 0) / 0 on the axis.
inline LocalUv turn_uv(const Vec3& p) {
    const double squared = p.x * p.x + p.y * p.y;
    LocalUv local;
    local.uv.x = turn_fraction(p.x, p.y);
    if (squared > 0.0) local.u_gradient = Vec3{-p.y, p.x, 0.0} / (2.0 * kPi * squared);
    return local;
}

/// Unit normal in the object's frame of a gradient in the local one.
inline Vec3 object_normal(const SolidFrame& frame, const Vec3& gradient, const Vec3& fallback) {
    return unit_or(transpose_times(frame.local_from_object, gradient), fallback);
}

}  // namespace alhazen
