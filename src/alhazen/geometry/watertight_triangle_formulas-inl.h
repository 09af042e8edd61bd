/// The arithmetic of the ray-triangle test, for double and for lanes of double: `Real` needs + - *
/// /, comparisons, and min_lanes, max_lanes, abs by argument-dependent lookup. A double acts as a
/// single lane.
///
/// A fragment without an include guard: watertight_triangle.h includes it in namespace alhazen;
/// code for an instruction set includes it again in its own namespace, because a compiler compiles
/// a template for the instruction set of the place where it is written (tests/unit/simd does). One
/// source gives one order of operations and the same bits.

/// A vertex relative to the ray, in sheared space: x and y across the ray, z along its dominant
/// axis.
template <class Real>
struct ShearedVertex {
    Real x, y, z;
};

template <class Real>
inline ShearedVertex<Real> sheared(const Real& vx, const Real& vy, const Real& vz, const Real& ox,
                                   const Real& oy, const Real& oz, const Real& sx, const Real& sy) {
    // Written so that no lanes are copied: compilers copy them by smaller registers than the one
    // that then waits for the copy.
    return {(vx - ox) - sx * (vz - oz), (vy - oy) - sy * (vz - oz), vz - oz};
}

/// Twice the signed area of (origin, a, b); zero or of the correct sign.
template <class Real>
inline Real edge_function(const ShearedVertex<Real>& a, const ShearedVertex<Real>& b) {
    return a.x * b.y - a.y * b.x;
}

/// The minimum of a single lane: the second operand if one is NaN.
inline double min_lanes(double a, double b) {
    return a < b ? a : b;
}
inline double max_lanes(double a, double b) {
    return a > b ? a : b;
}

/// The edge functions of a triangle: the weights of its vertices, up to a common factor.
template <class Real>
struct TriangleEdges {
    Real u, v, w;
    Real least, most;  ///< of u, v, w
    Real reach;        ///< largest |x| or |y| of a vertex

    TriangleEdges(const ShearedVertex<Real>& a, const ShearedVertex<Real>& b,
                  const ShearedVertex<Real>& c)
        : u(edge_function(b, c)),
          v(edge_function(c, a)),
          w(edge_function(a, b)),
          least(min_lanes(min_lanes(u, v), w)),
          most(max_lanes(max_lanes(u, v), w)),
          reach(max_lanes(max_lanes(reach_of(a), reach_of(b)), reach_of(c))) {}

    /// True if the ray passes outside the triangle.
    [[nodiscard]] auto missed() const { return (least < Real(0.0)) & (most > Real(0.0)); }
    /// True if no edge function is zero or NaN.
    [[nodiscard]] auto nonzero() const { return (least > Real(0.0)) | (most < Real(0.0)); }
    /// True if the sum of the edge functions has not cancelled so much that the weights, and with
    /// them the hit point, could be off by more than 2^-40 of the triangle: it is not seen nearly
    /// edge-on. False for NaN.
    [[nodiscard]] auto well_conditioned() const {
        using std::abs;
        return abs(u + v + w) > Real(0x1p-8) * reach * reach;
    }

  private:
    static Real reach_of(const ShearedVertex<Real>& a) {
        using std::abs;
        return max_lanes(abs(a.x), abs(a.y));
    }
};

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
    return {(eu * az + ev * bz + ew * cz) * sz / det, ev / det, ew / det};
}
