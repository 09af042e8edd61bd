#pragma once
/// Arithmetic with twice the digits of double, as a reference.

#include <cmath>

#include "alhazen/math/real128.h"
#include "alhazen/math/vec.h"

namespace alhazen::testing {

using Quad = Real128;

using alhazen::square_root;
inline Quad magnitude(Quad x) {
    return x < 0 ? -x : x;
}

struct QuadVec {
    Quad x, y, z;
    QuadVec(Quad a, Quad b, Quad c) : x(a), y(b), z(c) {}
    explicit QuadVec(const Vec3& v) : x(v.x), y(v.y), z(v.z) {}
};
inline QuadVec operator+(const QuadVec& a, const QuadVec& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline QuadVec operator-(const QuadVec& a, const QuadVec& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline QuadVec operator*(Quad s, const QuadVec& a) {
    return {s * a.x, s * a.y, s * a.z};
}
inline Quad dot(const QuadVec& a, const QuadVec& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline QuadVec cross(const QuadVec& a, const QuadVec& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline Quad length(const QuadVec& a) {
    return square_root(dot(a, a));
}
inline QuadVec normalize(const QuadVec& a) {
    return (1 / length(a)) * a;
}

}  // namespace alhazen::testing
