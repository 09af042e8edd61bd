/// The arithmetic of a blob's components along a ray; a fragment without a guard, included by
/// blob_pieces.h and by kernels in the namespace of each instruction set.
///
/// Source: see blob.h.
/// Differs: one square root and no division per ball, the same in double and in lanes.
/// Conventions: `Real` needs + - * and, by argument-dependent look-up, sqrt.

/// A line from a point near the blob: direction, its square, and the reciprocal of the square.
template <class Real>
struct BlobLine {
    Real dx, dy, dz, square, inverse;
};

/// Where a line is nearest the centre of a ball, and the square of the radius minus that of the
/// distance there. Where `room` is positive, 1 - (distance / radius)^2 along the line is peak -
/// bend (t - middle)^2 with the peak room / radius^2 and the bend square / radius^2.
template <class Real>
struct NearestPlace {
    Real middle, room;
};

/// (fx, fy, fz) is origin - centre; takes the square of the radius.
template <class Real>
[[gnu::always_inline]] inline NearestPlace<Real> nearest_place(const BlobLine<Real>& line,
                                                               const Real& fx, const Real& fy,
                                                               const Real& fz,
                                                               const Real& squared) {
    const Real middle = -(fx * line.dx + fy * line.dy + fz * line.dz) * line.inverse;
    const Real nx = fx + middle * line.dx;
    const Real ny = fy + middle * line.dy;
    const Real nz = fz + middle * line.dz;
    return {middle, squared - (nx * nx + ny * ny + nz * nz)};
}

/// Half the length in t of the line's part in the ball.
template <class Real>
[[gnu::always_inline]] inline Real half_chord(const BlobLine<Real>& line, const Real& room) {
    using std::sqrt;
    return sqrt(room * line.inverse);
}

/// Subtracts s q^2 from a polynomial of degree four, q with these coefficients; all in Bernstein
/// form.
template <class Real>
[[gnu::always_inline]] inline void take_square(const Real& q0, const Real& q1, const Real& q2,
                                               const Real& s, const Real& third_of_s, Real* b) {
    const Real middle = q1 * q1;
    b[0] = b[0] - s * (q0 * q0);
    b[1] = b[1] - s * (q0 * q1);
    b[2] = b[2] - third_of_s * (q0 * q2 + (middle + middle));
    b[3] = b[3] - s * (q1 * q2);
    b[4] = b[4] - s * (q2 * q2);
}
/// The same with q = peak - bend (t - middle)^2 on [t0, t1].
template <class Real>
[[gnu::always_inline]] inline void take_bump(const Real& middle, const Real& peak, const Real& bend,
                                             const Real& t0, const Real& t1, const Real& s,
                                             const Real& third_of_s, Real* b) {
    const Real from = t0 - middle, to = t1 - middle;
    take_square<Real>(peak - bend * (from * from), peak - bend * (from * to),
                      peak - bend * (to * to), s, third_of_s, b);
}
