/// The arithmetic of the ray-triangle test, for double and lanes of double alike: `Real` needs + -
/// * /.
///
/// A fragment without a guard: watertight_triangle.h includes it in namespace alhazen; code for an
/// instruction set includes it again in its own namespace, because a compiler compiles a template
/// for the instruction set of the place where it is written (tests/unit/simd does). One text gives
/// one order of operations and the same bits.

/// A vertex relative to the ray, in sheared space: x and y across the ray, z along its dominant
/// axis.
template <class Real>
struct ShearedVertex {
    Real x, y, z;
};

template <class Real>
inline ShearedVertex<Real> sheared(const Real& vx, const Real& vy, const Real& vz, const Real& ox,
                                   const Real& oy, const Real& oz, const Real& sx, const Real& sy) {
    const Real z = vz - oz;
    return {(vx - ox) - sx * z, (vy - oy) - sy * z, z};
}

/// Twice the signed area of (origin, a, b); its sign is correct or it is zero.
template <class Real>
inline Real edge_function(const ShearedVertex<Real>& a, const ShearedVertex<Real>& b) {
    return a.x * b.y - a.y * b.x;
}

/// t and barycentrics (weights of the second and third vertex) from the edge functions.
template <class Real>
struct TriangleSolution {
    Real t, u, v;
};
template <class Real>
inline TriangleSolution<Real> solve_triangle(const Real& eu, const Real& ev, const Real& ew,
                                             const Real& az, const Real& bz, const Real& cz,
                                             const Real& sz) {
    const Real det = eu + ev + ew;
    const Real t = (eu * az + ev * bz + ew * cz) * sz / det;
    return {t, ev / det, ew / det};
}
