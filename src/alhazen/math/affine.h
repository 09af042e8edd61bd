#pragma once
/// 3x3 matrices and affine transforms.
///
/// Transforms are named target-from-source: `world_from_object.point(p)` takes an object-space
/// point to world space. Vectors are columns.

#include "alhazen/math/vec.h"

namespace alhazen {

/// Three columns: `M * v = x_axis * v.x + y_axis * v.y + z_axis * v.z`.
struct Mat3 {
    Vec3 x_axis{1, 0, 0}, y_axis{0, 1, 0}, z_axis{0, 0, 1};
    friend bool operator==(const Mat3&, const Mat3&) = default;
};

[[gnu::always_inline]] inline Vec3 operator*(const Mat3& m, const Vec3& v) {
    return v.x * m.x_axis + v.y * m.y_axis + v.z * m.z_axis;
}
inline Mat3 operator*(const Mat3& a, const Mat3& b) {
    return {a * b.x_axis, a * b.y_axis, a * b.z_axis};
}
/// Transpose(m) * v.
inline Vec3 transpose_times(const Mat3& m, const Vec3& v) {
    return {dot(m.x_axis, v), dot(m.y_axis, v), dot(m.z_axis, v)};
}
inline double determinant(const Mat3& m) {
    return dot(m.x_axis, cross(m.y_axis, m.z_axis));
}
/// Inverse by cofactors. Not finite for a singular matrix.
[[nodiscard]] Mat3 inverse(const Mat3& m);
/// Upper bound of |m v| for vectors of length 1: the root of the largest eigenvalue of m's square,
/// which is at most the largest sum of a row (Gershgorin).
[[nodiscard]] double stretch_bound(const Mat3& m);

/// p -> linear * p + translation.
struct Affine {
    Mat3 linear;
    Vec3 translation;

    [[nodiscard, gnu::always_inline]] Vec3 point(const Vec3& p) const {
        return linear * p + translation;
    }
    [[nodiscard, gnu::always_inline]] Vec3 vector(const Vec3& v) const { return linear * v; }
    friend bool operator==(const Affine&, const Affine&) = default;

    [[nodiscard]] static Affine translate(const Vec3& offset) { return {{}, offset}; }
    [[nodiscard]] static Affine scale(const Vec3& factors);
    /// Right-handed rotation by `radians` about `axis`, which need not be a unit vector but must
    /// not be zero.
    [[nodiscard]] static Affine rotate(const Vec3& axis, double radians);
};

/// (a * b).point(p) == a.point(b.point(p)) up to rounding.
inline Affine operator*(const Affine& a, const Affine& b) {
    return {a.linear * b.linear, a.point(b.translation)};
}
/// Not finite for a singular transform.
[[nodiscard]] Affine inverse(const Affine& m);
/// True if every entry is finite and the linear part has an inverse with finite entries, and a
/// determinant that neither overflows nor underflows.
[[nodiscard]] bool is_invertible(const Affine& m);

}  // namespace alhazen
