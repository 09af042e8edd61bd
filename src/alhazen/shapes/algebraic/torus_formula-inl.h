/// The quartic of a torus on a segment; a fragment without a guard, included by torus.cpp in
/// namespace alhazen and by kernels in the namespace of each instruction set.

/// Bernstein coefficients of (x^2 + y^2 + z^2 + k)^2 - 4 (x^2 + y^2) on the segment from p to q.
/// `Point` has x, y and z of type Real; `third` is 1 / 3.
template <class Point, class Real>
inline void torus_coefficients(const Point& p, const Point& q, const Real& k, const Real& third,
                               Real* b) {
    const Real b0 = p.x * p.x + p.y * p.y;
    const Real b1 = p.x * q.x + p.y * q.y;
    const Real b2 = q.x * q.x + q.y * q.y;
    const Real a0 = b0 + p.z * p.z + k;
    const Real a1 = b1 + p.z * q.z + k;
    const Real a2 = b2 + q.z * q.z + k;
    const Real two(2.0), four(4.0);
    b[0] = a0 * a0 - four * b0;
    b[1] = a0 * a1 - two * (b0 + b1);
    b[2] = (a0 * a2 + two * (a1 * a1) - two * (b0 + four * b1 + b2)) * third;
    b[3] = a1 * a2 - two * (b1 + b2);
    b[4] = a2 * a2 - four * b2;
}
