#pragma once
/// The first crossings of eight rays with one polynomial solid, in lanes.
///
/// Source: polynomial_solid.h, the same operations in the same order.
/// Differs: a kernel computes the segments and the coefficients of eight rays; finds, from the
/// signs of the coefficients alone, which of them miss, begin inside, or have a bracket around
/// their first root; and refines the brackets. Rarer cases are left to the scalar code.
/// Conventions: internal to shapes/. Bit i of a set of lanes stands for lane i. Every target
/// returns the bits of the scalar code.

#include <cstddef>
#include <cstdint>
#include <span>

#include "alhazen/geometry/ray_lanes.h"
#include "alhazen/shapes/algebraic/polynomial_solid.h"

namespace alhazen {

struct Algebraic;
struct Torus;

/// State of the rays in the kernels, per lane.
struct alignas(64) PolynomialLanes {
    static constexpr std::size_t kCoefficients = 13;

    // Every row is a block that kernels load; nothing smaller lies between them.
    // ---- the segments, as ClipSegment
    double o[3][kRayLanes], d[3][kRayLanes];  ///< [axis][lane]
    double entry[kRayLanes], exit[kRayLanes], shift[kRayLanes], relative_error[kRayLanes];
    double entry_part[kRayLanes], exit_part[kRayLanes];  ///< whole numbers
    // ---- the polynomials on them
    double b[kCoefficients][kRayLanes], error[kRayLanes];
    // ---- for the bracketed lanes
    double lo[kRayLanes], hi[kRayLanes];
    double sign_lo[kRayLanes];          ///< sign of the polynomial at lo: 1 or -1
    double u[kRayLanes], t[kRayLanes];  ///< the root, once refined
    int degree;
    // ---- results for the first crossing; a lane in no set is unknown
    std::uint32_t unsure;     ///< not even the segment is known
    std::uint32_t missed;     ///< there is none
    std::uint32_t at_entry;   ///< it is at the start of the segment
    std::uint32_t bracketed;  ///< the only sign change in [lo, hi], if in the ray's range
    std::uint32_t last;       ///< it is the last one, with no cap behind it
    std::uint32_t steep;      ///< t is accurate to about its rounding
    std::uint32_t covered;    ///< t lies in the ray's range

    [[nodiscard]] ClipSegment segment(std::size_t lane) const {
        ClipSegment s;
        s.o = {o[0][lane], o[1][lane], o[2][lane]};
        s.d = {d[0][lane], d[1][lane], d[2][lane]};
        s.range = {entry[lane], exit[lane], static_cast<std::uint32_t>(entry_part[lane]),
                   static_cast<std::uint32_t>(exit_part[lane])};
        s.shift = shift[lane];
        s.relative_error = relative_error[lane];
        return s;
    }
    template <int N>
    void polynomial(std::size_t lane, BernsteinPolynomial<double, N>& p) const {
        p.degree = degree;
        p.error = error[lane];
        for (int i = 0; i <= degree; ++i) {
            p.b[static_cast<std::size_t>(i)] = b[i][lane];
        }
    }
};

/// The kernels of one instruction set.
struct PolynomialKernels {
    /// Compute segments, coefficients and the results of their signs.
    void (*torus)(const Torus&, const RayLanes&, PolynomialLanes&);
    void (*algebraic)(const Algebraic&, const RayLanes&, PolynomialLanes&);
    /// Refines the roots of the bracketed lanes.
    void (*refine)(const RayLanes&, PolynomialLanes&);
};

/// For the best instruction set of this machine, or the forced one (simd/targets.h).
[[nodiscard]] const PolynomialKernels& polynomial_kernels();

/// The root of a refined lane that is not steep enough: see `improved_root`.
template <class Polynomial>
double improved_root_of_lane(const Polynomial& f, const SolidFrame& frame, const Ray& ray,
                             std::size_t lane, const PolynomialLanes& lanes) {
    constexpr int N = Polynomial::kDegree;
    const ClipSegment s = lanes.segment(lane);
    const CoveredSignChanges covered{ray, s.range};
    BernsteinPolynomial<double, N> p;
    lanes.polynomial(lane, p);
    SignChanges<N> changes;
    changes.u[0] = lanes.u[lane];
    changes.lo[0] = lanes.lo[lane];
    changes.hi[0] = lanes.hi[lane];
    return improved_root(f, frame, ray, covered, p, changes, 0);
}

/// The first crossings of up to eight rays; returns the set of rays that hit. `begin(kernels, in,
/// lanes)` calls the kernel of the shape, `improve(ray, lane, lanes)` is `improved_root_of_lane`,
/// and `alone(ray, hit)` is the scalar code.
template <class Begin, class Improve, class Alone>
std::uint32_t first_hits_in_lanes(std::span<const Ray* const> rays, ShapeHit* hits, Begin&& begin,
                                  Improve&& improve, Alone&& alone) {
    const PolynomialKernels& kernels = polynomial_kernels();
    RayLanes in;
    PolynomialLanes lanes;
    for (std::size_t i = 0; i < kRayLanes; ++i) in.set(i, *rays[i < rays.size() ? i : 0]);
    const std::uint32_t used = kAllRayLanes >> (kRayLanes - rays.size());
    begin(kernels, in, lanes);
    std::uint32_t hit = used & lanes.at_entry;
    const auto ask_alone = [&](std::size_t i) {
        if (alone(*rays[i], hits[i])) hit |= 1u << i;
    };
    for_each_lane(hit, [&](std::size_t i) {
        hits[i] = {lanes.entry[i], 0, 0, static_cast<std::uint32_t>(lanes.entry_part[i])};
    });
    for_each_lane(used & ~(lanes.missed | lanes.at_entry | lanes.bracketed), ask_alone);
    lanes.bracketed &= used;
    if (lanes.bracketed == 0) return hit;
    kernels.refine(in, lanes);
    const std::uint32_t right = lanes.bracketed & lanes.steep;
    hit |= right & lanes.covered;
    for_each_lane(right & lanes.covered, [&](std::size_t i) { hits[i] = {lanes.t[i], 0, 0, 0}; });
    for_each_lane(right & ~lanes.covered & ~lanes.last, ask_alone);
    for_each_lane(lanes.bracketed & ~lanes.steep, [&](std::size_t i) {
        if (report_crossing(*rays[i], {improve(*rays[i], i, lanes), 0, 0, 0}, hits + i) > 0) {
            hit |= 1u << i;
        } else if ((lanes.last >> i & 1) == 0) {
            ask_alone(i);  // for later crossings
        }
    });
    return hit;
}

}  // namespace alhazen
