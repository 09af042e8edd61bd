/// The arithmetic of the ray-sphere intersection; a fragment without an include guard, included by
/// sphere_roots.h in namespace alhazen and by kernels in the namespace of each instruction set (the
/// reason: watertight_triangle_formulas-inl.h).

/// `t_near <= t_far` if `discriminant >= 0`; unspecified, possibly NaN, if it is negative (the line
/// misses).
template <class Real>
struct SphereRoots {
    Real discriminant, t_near, t_far;
};

/// A line relative to a sphere: half the linear coefficient of the quadratic, and its (scaled)
/// discriminant, which is not negative if the line intersects the sphere.
template <class Real>
struct SphereLine {
    Real b, discriminant;
};

/// (dx, dy, dz) is the direction, (fx, fy, fz) = origin - centre, a = |direction|^2 summed as x, y,
/// z. `Real` needs + - * /, unary -, and sqrt, copysign, fmin, fmax by argument-dependent lookup
/// (or <cmath>); fmin and fmax ignore a NaN operand.
template <class Real>
inline SphereLine<Real> sphere_line(const Real& dx, const Real& dy, const Real& dz, const Real& a,
                                    const Real& fx, const Real& fy, const Real& fz,
                                    const Real& radius) {
    const Real b = fx * dx + fy * dy + fz * dz;
    const Real s = b / a;
    // The point of the line nearest to the centre.
    const Real lx = fx - s * dx;
    const Real ly = fy - s * dy;
    const Real lz = fz - s * dz;
    return {b, radius * radius - (lx * lx + ly * ly + lz * lz)};
}

/// Both roots of a line from `sphere_line`.
template <class Real>
inline SphereRoots<Real> sphere_roots(const SphereLine<Real>& line, const Real& a, const Real& fx,
                                      const Real& fy, const Real& fz, const Real& radius) {
    using std::copysign;
    using std::sqrt;
    const Real q = line.b + copysign(sqrt(line.discriminant * a), line.b);
    const Real f = sqrt(fx * fx + fy * fy + fz * fz);
    const Real c = (f - radius) * (f + radius);
    // The roots of a t^2 + 2 b t + c = 0 are -q / a and -c / q; the former has the larger
    // magnitude.
    const Real big = -(q / a);
    // If the origin lies on the sphere and the line grazes it, c and q are rounding errors and
    // their quotient is arbitrary; the true root is no larger in magnitude than the other one.
    using std::fmax;
    using std::fmin;
    const Real reach = copysign(big, a);
    const Real small = fmax(-reach, fmin(reach, -(c / q)));
    // b > 0: q > 0 and `big` is the nearer (more negative) root.
    return {line.discriminant, fmin(big, small), fmax(big, small)};
}

/// The roots, with the same bits, if the origin lies outside and the ray approaches the sphere: b <
/// 0 and c = (f - radius) (f + radius) > 0, with f as in `sphere_roots`.
template <class Real>
inline SphereRoots<Real> sphere_roots_ahead(const SphereLine<Real>& line, const Real& a,
                                            const Real& c) {
    using std::fmin;
    using std::sqrt;
    const Real q = line.b - sqrt(line.discriminant * a);
    const Real big = -(q / a);
    return {line.discriminant, fmin(big, -(c / q)), big};
}

template <class Real>
inline SphereRoots<Real> sphere_roots(const Real& dx, const Real& dy, const Real& dz, const Real& a,
                                      const Real& fx, const Real& fy, const Real& fz,
                                      const Real& radius) {
    return sphere_roots(sphere_line(dx, dy, dz, a, fx, fy, fz, radius), a, fx, fy, fz, radius);
}
