#pragma once
/// Two- and three-component vectors of double.
///
/// Every operation is a fixed sequence of IEEE operations, evaluated as written (the build forbids
/// contraction), so equal inputs give equal bits on every machine.

#include <cmath>

namespace alhazen {

struct Vec2 {
    double x = 0, y = 0;
    friend bool operator==(const Vec2&, const Vec2&) = default;
};

inline Vec2 operator+(Vec2 a, Vec2 b) {
    return {a.x + b.x, a.y + b.y};
}
inline Vec2 operator-(Vec2 a, Vec2 b) {
    return {a.x - b.x, a.y - b.y};
}
inline Vec2 operator*(double s, Vec2 a) {
    return {s * a.x, s * a.y};
}
inline Vec2 operator*(Vec2 a, double s) {
    return s * a;
}

struct Vec3 {
    double x = 0, y = 0, z = 0;

    double& operator[](int axis) { return (&x)[axis]; }
    const double& operator[](int axis) const { return (&x)[axis]; }
    friend bool operator==(const Vec3&, const Vec3&) = default;
};

inline Vec3 operator+(const Vec3& a, const Vec3& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline Vec3 operator-(const Vec3& a, const Vec3& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline Vec3 operator-(const Vec3& a) {
    return {-a.x, -a.y, -a.z};
}
inline Vec3 operator*(double s, const Vec3& a) {
    return {s * a.x, s * a.y, s * a.z};
}
inline Vec3 operator*(const Vec3& a, double s) {
    return s * a;
}
/// Componentwise product.
inline Vec3 operator*(const Vec3& a, const Vec3& b) {
    return {a.x * b.x, a.y * b.y, a.z * b.z};
}
inline Vec3 operator/(const Vec3& a, double s) {
    return {a.x / s, a.y / s, a.z / s};
}
inline Vec3& operator+=(Vec3& a, const Vec3& b) {
    return a = a + b;
}
inline Vec3& operator-=(Vec3& a, const Vec3& b) {
    return a = a - b;
}

inline double dot(const Vec3& a, const Vec3& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline Vec3 cross(const Vec3& a, const Vec3& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double length_squared(const Vec3& a) {
    return dot(a, a);
}
inline double length(const Vec3& a) {
    return std::sqrt(dot(a, a));
}
/// The unit vector along `a`; NaN for a zero vector.
inline Vec3 normalize(const Vec3& a) {
    return a / length(a);
}
inline Vec3 abs(const Vec3& a) {
    return {std::abs(a.x), std::abs(a.y), std::abs(a.z)};
}
inline double max_component(const Vec3& a) {
    return std::fmax(a.x, std::fmax(a.y, a.z));
}
inline bool is_finite(const Vec3& a) {
    return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z);
}
/// The axis (0, 1, 2) along which `a` is longest; the lowest if several are.
inline int dominant_axis(const Vec3& a) {
    const Vec3 m = abs(a);
    if (m.x >= m.y && m.x >= m.z) return 0;
    return m.y >= m.z ? 1 : 2;
}
/// A unit vector perpendicular to the unit vector `n`.
/// Source: Duff et al., "Building an Orthonormal Basis, Revisited", JCGT 6(1), 2017.
inline Vec3 perpendicular(const Vec3& n) {
    const double sign = std::copysign(1.0, n.z);
    const double a = -1.0 / (sign + n.z);
    return {1.0 + sign * n.x * n.x * a, sign * n.x * n.y * a, -sign * n.x};
}

}  // namespace alhazen
