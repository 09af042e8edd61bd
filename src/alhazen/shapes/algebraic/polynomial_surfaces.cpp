/// The surfaces of tori and algebraic surfaces in lanes (shapes/core/lane_surfaces.h).
///
/// Source: torus.cpp and `project_to_zero` of polynomial_solid.h, the same operations in the same
/// order.
/// Differs: points at which the scalar code needs a fallback, expressions of more than kMostNodes
/// operations and targets without exact fused operations are left to it.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

#include "alhazen/shapes/algebraic/algebraic.h"
#include "alhazen/shapes/algebraic/torus.h"
#include "alhazen/shapes/core/lane_surfaces.h"
#include "alhazen/simd/dispatch.h"

// Compiles the rest of this file once per target.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "alhazen/shapes/algebraic/polynomial_surfaces.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// After foreach_target.h.
#include "alhazen/shapes/core/lane_surface_formulas-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {
namespace polynomial_surfaces {

using namespace lane_surface_formulas;
template <std::size_t N>
using Mask = LaneMask<double, N>;
using Node = PolynomialExpression::Node;

template <std::size_t N>
HWY_INLINE std::uint32_t torus_of(const Torus& shape, std::uint32_t wanted, std::size_t first,
                                  LaneSurfaces& lanes) {
    const SolidFrame& frame = shape.frame;
    const Numbers<N> nothing(0.0), unit(1.0);
    const VectorLanes<N> p =
        times(frame.local_from_object, hit_points<N>(lanes, first) - vectors_of<N>(frame.origin));
    // As `nearest_on_tube`.
    const Numbers<N> across = sqrt(p.x * p.x + p.y * p.y), out = across - unit;
    const Numbers<N> distance = sqrt(out * out + p.z * p.z);
    Mask<N> sure = (across > nothing) & (distance > nothing);
    const Numbers<N> scale = Numbers<N>(shape.tube) / distance;
    const Numbers<N> ratio = (unit + out * scale) / across, radial = out / across;
    const VectorLanes<N> nearest{p.x * ratio, p.y * ratio, p.z * scale};
    const VectorLanes<N> gradient{p.x * radial, p.y * radial, p.z};
    const VectorLanes<N> normal = unit_of(transpose_times(frame.local_from_object, gradient), sure);
    const VectorLanes<N> point =
        times(frame.object_from_local, nearest) + vectors_of<N>(frame.origin);
    return finish(point, normal, sure, wanted, first, lanes);
}

/// Numbers of two doubles: math/double_double.h.
template <std::size_t N>
struct Pair {
    Numbers<N> high, low;
};
template <std::size_t N>
HWY_INLINE Pair<N> two_sum(const Numbers<N>& a, const Numbers<N>& b) {
    const Numbers<N> sum = a + b, b_virtual = sum - a;
    return {sum, (a - (sum - b_virtual)) + (b - b_virtual)};
}
template <std::size_t N>
HWY_INLINE Pair<N> fast_two_sum(const Numbers<N>& a, const Numbers<N>& b) {
    const Numbers<N> sum = a + b;
    return {sum, b - (sum - a)};
}
template <std::size_t N>
HWY_INLINE Pair<N> operator-(const Pair<N>& a) {
    return {-a.high, -a.low};
}
template <std::size_t N>
HWY_INLINE Pair<N> operator+(const Pair<N>& a, const Pair<N>& b) {
    const Pair<N> s = two_sum(a.high, b.high), t = two_sum(a.low, b.low);
    const Pair<N> v = fast_two_sum(s.high, s.low + t.high);
    return fast_two_sum(v.high, t.low + v.low);
}
template <std::size_t N>
HWY_INLINE Pair<N> operator*(const Pair<N>& a, const Pair<N>& b) {
    const Numbers<N> product = a.high * b.high, rest = mul_sub(a.high, b.high, product);
    const Numbers<N> low = mul_add(a.low, b.high, mul_add(a.high, b.low, a.low * b.low));
    return fast_two_sum(product, rest + low);
}

/// The product of two doubles is exact, and is what the product of their pairs rounds to.
template <std::size_t N>
HWY_INLINE Pair<N> square_of(const Numbers<N>& a) {
    const Numbers<N> product = a * a;
    return {product, mul_sub(a, a, product)};
}
HWY_INLINE bool is_coordinate(const Node& n) {
    using enum PolynomialExpression::Op;
    return n.op == X || n.op == Y || n.op == Z;
}

constexpr std::size_t kMostNodes = 64;

/// Values of the nodes of an expression; storage that is set before it is used.
template <class T>
struct NodeValues {
    alignas(64) std::byte bytes[kMostNodes * sizeof(T)];
    T& operator[](std::size_t i) { return reinterpret_cast<T*>(bytes)[i]; }
};

/// A value in double and its gradient.
template <std::size_t N>
struct Slope {
    Numbers<N> v;
    VectorLanes<N> g;

    static HWY_INLINE Slope constant(const DoubleDouble& c) {
        return {Numbers<N>(c.high), vectors_of<N>({})};
    }
    static HWY_INLINE Slope coordinate(const Numbers<N>& x, const Vec3& axis) {
        return {x, vectors_of<N>(axis)};
    }
    friend HWY_INLINE Slope operator+(const Slope& a, const Slope& b) {
        return {a.v + b.v, a.g + b.g};
    }
    friend HWY_INLINE Slope operator-(const Slope& a, const Slope& b) {
        return {a.v - b.v, a.g - b.g};
    }
    friend HWY_INLINE Slope product(const Slope& a, const Slope& b, bool) {
        return {a.v * b.v, b.v * a.g + a.v * b.g};
    }
};
/// The same, and the value in double-double. They are computed together: neither waits for the
/// other.
template <std::size_t N>
struct ValueAndSlope {
    Pair<N> exact;
    Slope<N> slope;

    static HWY_INLINE ValueAndSlope constant(const DoubleDouble& c) {
        return {{Numbers<N>(c.high), Numbers<N>(c.low)}, Slope<N>::constant(c)};
    }
    static HWY_INLINE ValueAndSlope coordinate(const Numbers<N>& x, const Vec3& axis) {
        return {{x, Numbers<N>(0.0)}, Slope<N>::coordinate(x, axis)};
    }
    friend HWY_INLINE ValueAndSlope operator+(const ValueAndSlope& a, const ValueAndSlope& b) {
        return {a.exact + b.exact, a.slope + b.slope};
    }
    friend HWY_INLINE ValueAndSlope operator-(const ValueAndSlope& a, const ValueAndSlope& b) {
        return {a.exact + -b.exact, a.slope - b.slope};
    }
    friend HWY_INLINE ValueAndSlope product(const ValueAndSlope& a, const ValueAndSlope& b,
                                            bool is_square) {
        return {is_square ? square_of(a.exact.high) : a.exact * b.exact,
                product(a.slope, b.slope, is_square)};
    }
};

/// The expression at the points, as a Slope or a ValueAndSlope.
template <class Value, std::size_t N>
HWY_INLINE Value at_point(std::span<const Node> nodes, const VectorLanes<N>& p) {
    using enum PolynomialExpression::Op;
    NodeValues<Value> of;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const Node& n = nodes[i];
        const Value &a = of[n.a], &b = of[n.b];
        switch (n.op) {
            case Constant:
                of[i] = Value::constant(n.constant);
                break;
            case X:
                of[i] = Value::coordinate(p.x, {1, 0, 0});
                break;
            case Y:
                of[i] = Value::coordinate(p.y, {0, 1, 0});
                break;
            case Z:
                of[i] = Value::coordinate(p.z, {0, 0, 1});
                break;
            case Add:
                of[i] = a + b;
                break;
            case Subtract:
                of[i] = a - b;
                break;
            case Multiply:
                of[i] = product(a, b, n.a == n.b && is_coordinate(nodes[n.a]));
                break;
        }
    }
    return of[nodes.size() - 1];
}

template <std::size_t N>
HWY_INLINE Numbers<N> largest_of(const VectorLanes<N>& v) {
    return max_lanes(v.x, max_lanes(v.y, v.z));
}
template <std::size_t N>
HWY_INLINE Numbers<N> length_of(const VectorLanes<N>& v) {
    return sqrt(dot(v, v));
}

/// The lanes in which the scalar code moves a point once: after a step s from p by Newton's method
/// the next one is certainly below its threshold of 2^-51 max |p|.
///
/// Let m be the sum of the absolute terms over the clip, n the degree, r the least of the clip's
/// largest coordinates, k the roundings. On the clip |df/dx| <= n m / r, and second derivatives are
/// at most n^2 m / r^2; the computed gradient g is wrong by at most e = k n m 2^-53 / r. After the
/// step, with the rounding d of the point, |d| <= (3^(1/2) max |p| + 6 |s|) 2^-53,
///   |f| <= |g| |d| + |s| 3^(1/2) e + 3 n^2 m / r^2 |s|^2 + 2^-95 m,
/// the last term for double-double. The conditions make the second and third terms at most
/// 2^-19 |s| |g| each, so at most 2^-54 |g| max |p| together, as |s| <= 2^-36 max |p|, and the last
/// at most 2^-55 |g| max |p|; g changes by less than a 2^18th. Then
/// |f| / |g| < (1.74 + 0.5 + 0.25 + 0.01) 2^-53 max |p| < 2^-51 max |p|.
template <std::size_t N>
HWY_INLINE std::uint32_t settled_by_step(const Algebraic& shape, const VectorLanes<N>& p,
                                         const Numbers<N>& step, const Numbers<N>& steepness) {
    const double degree = shape.polynomial->degree(), m = shape.magnitude;
    const double slope = degree * m / shape.size, bend = 3.0 * degree * slope / shape.size;
    const VectorLanes<N> away = abs(p);
    const Numbers<N> largest = largest_of(away);
    // A point far from the ray's origin may be rounded out of the clip.
    const Vec3 &lo = shape.clip_box.lo, &hi = shape.clip_box.hi;
    const auto within = [](const Numbers<N>& x, double low, double high) HWY_ATTR {
        return x <= Numbers<N>(1.001 * std::max(std::abs(low), std::abs(high)));
    };
    return bits_of((step <= Numbers<N>(0x1p-36) * largest) &
                   (steepness >= Numbers<N>(0x1p-30 * shape.roundings * slope)) &
                   (steepness >= Numbers<N>(0x1p20 * bend) * step) &
                   (steepness * largest >= Numbers<N>(0x1p-40 * m)) & within(away.x, lo.x, hi.x) &
                   within(away.y, lo.y, hi.y) & within(away.z, lo.z, hi.z));
}

template <std::size_t N>
HWY_INLINE std::uint32_t algebraic_of(const Algebraic& shape, std::uint32_t wanted,
                                      std::size_t first, LaneSurfaces& lanes) {
    const std::span<const Node> nodes(shape.polynomial->nodes());
    const Numbers<N> nothing(0.0);
    VectorLanes<N> p = hit_points<N>(lanes, first);
    ValueAndSlope<N> f = at_point<ValueAndSlope<N>>(nodes, p);
    Numbers<N> squared = dot(f.slope.g, f.slope.g);
    Mask<N> sure = squared > nothing;
    const VectorLanes<N> back =
        Numbers<N>(-1e-6 * shape.size) * unit_of(load_from<N>(lanes.direction, first), sure);
    const Numbers<N> most = Numbers<N>(1e-5) * (length_of(p) + length_of(back));
    std::uint32_t moving = wanted & bits_of(sure);
    for (int i = 0; i < 2; ++i) {
        const VectorLanes<N> step = (f.exact.high / squared) * f.slope.g;
        const Numbers<N> size = length_of(step);
        const VectorLanes<N> next = p - step;
        const Mask<N> moves = (size <= most) & !(size <= Numbers<N>(0x1p-51) * largest_of(abs(p))) &
                              ((next.x < p.x) | (next.x > p.x) | (next.y < p.y) | (next.y > p.y) |
                               (next.z < p.z) | (next.z > p.z));
        moving &= bits_of(moves);
        if (moving == 0) break;
        const std::uint32_t settled = settled_by_step(shape, p, size, sqrt(squared));
        p = select_lanes(lanes_of_bits<double, N>(moving), next, p);
        if (i == 1 || (moving & ~settled) == 0) {
            f.slope = at_point<Slope<N>>(nodes, p);
            squared = dot(f.slope.g, f.slope.g);
            break;
        }
        f = at_point<ValueAndSlope<N>>(nodes, p);
        squared = dot(f.slope.g, f.slope.g);
        moving &= bits_of(squared > nothing);
    }
    sure = sure & (squared > nothing);
    return finish(p, unit_of(f.slope.g, sure), sure, wanted, first, lanes);
}

std::uint32_t torus(const Torus& shape, std::uint32_t wanted, LaneSurfaces& lanes) {
    return for_lane_blocks(wanted, [&](auto n, std::size_t first, std::uint32_t set) HWY_ATTR {
        return torus_of<n()>(shape, set, first, lanes);
    });
}
std::uint32_t algebraic(const Algebraic& shape, std::uint32_t wanted, LaneSurfaces& lanes) {
    if (!kFusesExactly || shape.polynomial->nodes().size() > kMostNodes) return 0;
    // Larger blocks take the steps of their slowest lane.
    return for_blocks_of_eight(wanted, [&](auto n, std::size_t first, std::uint32_t set) HWY_ATTR {
        return algebraic_of<n()>(shape, set, first, lanes);
    });
}

}  // namespace polynomial_surfaces

auto torus_surfaces_of_target() -> std::uint32_t (*)(const Torus&, std::uint32_t, LaneSurfaces&) {
    return &polynomial_surfaces::torus;
}
auto algebraic_surfaces_of_target()
    -> std::uint32_t (*)(const Algebraic&, std::uint32_t, LaneSurfaces&) {
    return &polynomial_surfaces::algebraic;
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace alhazen {

ALHAZEN_KERNEL_TABLE(torus_surfaces_of_target);
ALHAZEN_KERNEL_TABLE(algebraic_surfaces_of_target);

std::uint32_t lane_surfaces(const Torus& shape, std::uint32_t wanted, LaneSurfaces& lanes) {
    return ALHAZEN_KERNEL(torus_surfaces_of_target)()(shape, wanted, lanes);
}
std::uint32_t lane_surfaces(const Algebraic& shape, std::uint32_t wanted, LaneSurfaces& lanes) {
    return ALHAZEN_KERNEL(algebraic_surfaces_of_target)()(shape, wanted, lanes);
}

}  // namespace alhazen
#endif
