/// The surfaces of tori and algebraic surfaces in lanes (shapes/core/lane_surfaces.h).
///
/// Source: torus.cpp and `project_to_zero` of polynomial_solid.h, the same operations in the same
/// order.
/// Differs: points at which the scalar code needs a fallback, expressions of more than kMostNodes
/// operations and targets without exact fused operations are left to it.

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
using Node = PolynomialExpression::Node;

std::uint32_t torus(const Torus& shape, std::uint32_t wanted, LaneSurfaces& lanes) {
    const SolidFrame& frame = shape.frame;
    const Doubles nothing(0.0), unit(1.0);
    const Vectors p = times(frame.local_from_object, hit_points(lanes) - vectors_of(frame.origin));
    // As `nearest_on_tube`.
    const Doubles across = sqrt(p.x * p.x + p.y * p.y), out = across - unit;
    const Doubles distance = sqrt(out * out + p.z * p.z);
    Mask sure = (across > nothing) & (distance > nothing);
    const Doubles scale = Doubles(shape.tube) / distance;
    const Doubles ratio = (unit + out * scale) / across, radial = out / across;
    const Vectors nearest{p.x * ratio, p.y * ratio, p.z * scale};
    const Vectors gradient{p.x * radial, p.y * radial, p.z};
    const Vectors normal = unit_of(transpose_times(frame.local_from_object, gradient), sure);
    const Vectors point = times(frame.object_from_local, nearest) + vectors_of(frame.origin);
    return finish(point, normal, sure, wanted, lanes);
}

/// Numbers of two doubles: math/double_double.h.
struct Pair {
    Doubles high, low;
};
HWY_INLINE Pair two_sum(const Doubles& a, const Doubles& b) {
    const Doubles sum = a + b, b_virtual = sum - a;
    return {sum, (a - (sum - b_virtual)) + (b - b_virtual)};
}
HWY_INLINE Pair fast_two_sum(const Doubles& a, const Doubles& b) {
    const Doubles sum = a + b;
    return {sum, b - (sum - a)};
}
HWY_INLINE Pair operator-(const Pair& a) {
    return {-a.high, -a.low};
}
HWY_INLINE Pair operator+(const Pair& a, const Pair& b) {
    const Pair s = two_sum(a.high, b.high), t = two_sum(a.low, b.low);
    const Pair v = fast_two_sum(s.high, s.low + t.high);
    return fast_two_sum(v.high, t.low + v.low);
}
HWY_INLINE Pair operator*(const Pair& a, const Pair& b) {
    const Doubles product = a.high * b.high, rest = mul_sub(a.high, b.high, product);
    const Doubles low = mul_add(a.low, b.high, mul_add(a.high, b.low, a.low * b.low));
    return fast_two_sum(product, rest + low);
}

constexpr std::size_t kMostNodes = 64;

/// Values of the nodes of an expression; storage that is set before it is used.
template <class T>
struct NodeValues {
    alignas(64) std::byte bytes[kMostNodes * sizeof(T)];
    T& operator[](std::size_t i) { return reinterpret_cast<T*>(bytes)[i]; }
};

/// The value of the expression, rounded from double-double.
HWY_INLINE Doubles value_at(std::span<const Node> nodes, const Vectors& p) {
    using enum PolynomialExpression::Op;
    const Doubles nothing(0.0);
    NodeValues<Pair> of;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const Node& n = nodes[i];
        switch (n.op) {
            case Constant:
                of[i] = {Doubles(n.constant.high), Doubles(n.constant.low)};
                break;
            case X:
                of[i] = {p.x, nothing};
                break;
            case Y:
                of[i] = {p.y, nothing};
                break;
            case Z:
                of[i] = {p.z, nothing};
                break;
            case Add:
                of[i] = of[n.a] + of[n.b];
                break;
            case Subtract:
                of[i] = of[n.a] + -of[n.b];
                break;
            case Multiply:
                of[i] = of[n.a] * of[n.b];
                break;
        }
    }
    return of[nodes.size() - 1].high;
}

HWY_INLINE Vectors gradient_at(std::span<const Node> nodes, const Vectors& p) {
    using enum PolynomialExpression::Op;
    struct Value {
        Doubles v;
        Vectors g;
    };
    NodeValues<Value> of;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const Node& n = nodes[i];
        switch (n.op) {
            case Constant:
                of[i] = {Doubles(n.constant.high), vectors_of({})};
                break;
            case X:
                of[i] = {p.x, vectors_of({1, 0, 0})};
                break;
            case Y:
                of[i] = {p.y, vectors_of({0, 1, 0})};
                break;
            case Z:
                of[i] = {p.z, vectors_of({0, 0, 1})};
                break;
            case Add:
                of[i] = {of[n.a].v + of[n.b].v, of[n.a].g + of[n.b].g};
                break;
            case Subtract:
                of[i] = {of[n.a].v - of[n.b].v, of[n.a].g - of[n.b].g};
                break;
            case Multiply:
                of[i] = {of[n.a].v * of[n.b].v, of[n.b].v * of[n.a].g + of[n.a].v * of[n.b].g};
                break;
        }
    }
    return of[nodes.size() - 1].g;
}

HWY_INLINE Doubles largest_of(const Vectors& v) {
    return max_lanes(v.x, max_lanes(v.y, v.z));
}
HWY_INLINE Doubles length_of(const Vectors& v) {
    return sqrt(dot(v, v));
}

std::uint32_t algebraic(const Algebraic& shape, std::uint32_t wanted, LaneSurfaces& lanes) {
    const std::span<const Node> nodes(shape.polynomial->nodes());
    if (!kFusesExactly || nodes.size() > kMostNodes) return 0;
    const Doubles nothing(0.0);
    Vectors p = hit_points(lanes);
    Vectors gradient = gradient_at(nodes, p);
    Doubles value = value_at(nodes, p), squared = dot(gradient, gradient);
    Mask sure = squared > nothing;
    const Vectors back = Doubles(-1e-6 * shape.size) * unit_of(load_vectors(lanes.direction), sure);
    const Doubles most = Doubles(1e-5) * (length_of(p) + length_of(back));
    std::uint32_t moving = wanted & bits_of(sure);
    for (int i = 0; i < 2; ++i) {
        const Vectors step = (value / squared) * gradient;
        const Doubles size = length_of(step);
        const Vectors next = p - step;
        const Mask moves = (size <= most) & !(size <= Doubles(0x1p-51) * largest_of(abs(p))) &
                           ((next.x < p.x) | (next.x > p.x) | (next.y < p.y) | (next.y > p.y) |
                            (next.z < p.z) | (next.z > p.z));
        moving &= bits_of(moves);
        if (moving == 0) break;
        p = select_lanes(lanes_of_bits<double>(moving), next, p);
        gradient = gradient_at(nodes, p);
        squared = dot(gradient, gradient);
        moving &= bits_of(squared > nothing);
        if (i == 0) value = value_at(nodes, p);
    }
    sure = sure & (squared > nothing);
    return finish(p, unit_of(gradient, sure), sure, wanted, lanes);
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
