#include "alhazen/illumination/light_importance.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace alhazen {

namespace {

double sine_of(double cosine) {
    return std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
}

/// The cosine of max(0, a - b) for angles a and b given by their cosines and sines.
double cosine_of_difference(double cosine_a, double sine_a, double cosine_b, double sine_b) {
    return cosine_a > cosine_b ? 1.0 : cosine_a * cosine_b + sine_a * sine_b;
}
/// The sine of max(0, a - b).
double sine_of_difference(double cosine_a, double sine_a, double cosine_b, double sine_b) {
    return cosine_a > cosine_b ? 0.0 : sine_a * cosine_b - cosine_a * sine_b;
}

}  // namespace

double importance(const LightTree::Node& n, const LitPoint& at) {
    const Vec3 lo{n.lo[0], n.lo[1], n.lo[2]}, hi{n.hi[0], n.hi[1], n.hi[2]};
    const Vec3 offset = 0.5 * (lo + hi) - at.point;
    const double radius2 = 0.25 * length_squared(hi - lo), squared = length_squared(offset);
    // Inside the sphere around the node all directions are possible.
    if (!(squared > radius2)) return n.intensity / std::max(radius2, 1e-300);
    const double distance = std::sqrt(squared);
    const Vec3 to_light = offset / distance;
    const double sine_b = std::min(1.0, std::sqrt(radius2) / distance);
    const double cosine_b = std::sqrt(1.0 - sine_b * sine_b);

    double cosine_w = -(n.axis[0] * to_light.x + n.axis[1] * to_light.y + n.axis[2] * to_light.z);
    if (n.two_sided) cosine_w = std::abs(cosine_w);
    cosine_w = std::clamp(cosine_w, -1.0, 1.0);
    const double sine_w = sine_of(cosine_w);
    const double cosine_o = n.cosine_spread, sine_o = sine_of(cosine_o);
    const double cosine_x = cosine_of_difference(cosine_w, sine_w, cosine_o, sine_o);
    const double sine_x = sine_of_difference(cosine_w, sine_w, cosine_o, sine_o);
    const double cosine_out = cosine_of_difference(cosine_x, sine_x, cosine_b, sine_b);
    if (cosine_out <= n.cosine_reach) return 0.0;
    // Lights other than surfaces have no cosine.
    const double sent = n.cosine_reach < 0.0 ? 1.0 : cosine_out;

    if (at.in_volume) return n.intensity * sent / squared;
    double cosine_i = dot(at.normal, to_light);
    if (at.both_sides) cosine_i = std::abs(cosine_i);
    cosine_i = std::clamp(cosine_i, -1.0, 1.0);
    const double received = cosine_of_difference(cosine_i, sine_of(cosine_i), cosine_b, sine_b);
    if (!(received > 0.0)) return 0.0;
    return n.intensity * sent * received / squared;
}

#if defined(__SSE2__)

namespace {

using Pair = __m128d;

Pair both(double x) {
    return _mm_set1_pd(x);
}
/// Lanes of `yes` where the mask is set, else of `no`.
Pair chosen(Pair mask, Pair yes, Pair no) {
    return _mm_or_pd(_mm_and_pd(mask, yes), _mm_andnot_pd(mask, no));
}
/// std::max(b, a) and std::min(b, a) of lanes: a NaN in `a` gives `b`.
Pair larger(Pair a, Pair b) {
    return _mm_max_pd(a, b);
}
Pair smaller(Pair a, Pair b) {
    return _mm_min_pd(a, b);
}
Pair clamped_cosine(Pair x) {
    return smaller(both(1.0), larger(both(-1.0), x));
}
Pair magnitude(Pair x) {
    return _mm_andnot_pd(both(-0.0), x);
}
Pair sine_of(Pair cosine) {
    return _mm_sqrt_pd(larger(both(1.0) - cosine * cosine, both(0.0)));
}
Pair cosine_of_difference(Pair cosine_a, Pair sine_a, Pair cosine_b, Pair sine_b) {
    return chosen(_mm_cmpgt_pd(cosine_a, cosine_b), both(1.0),
                  cosine_a * cosine_b + sine_a * sine_b);
}
Pair sine_of_difference(Pair cosine_a, Pair sine_a, Pair cosine_b, Pair sine_b) {
    return _mm_andnot_pd(_mm_cmpgt_pd(cosine_a, cosine_b), sine_a * cosine_b - cosine_a * sine_b);
}

/// The first twelve floats of two nodes, in lanes.
struct NodeNumbers {
    Pair of[12];
};
NodeNumbers numbers_of(const LightTree::Node* two) {
    static_assert(offsetof(LightTree::Node, intensity) == 11 * sizeof(float));
    NodeNumbers numbers;
    for (int i = 0; i < 12; i += 4) {
        const __m128 first = _mm_loadu_ps(two[0].lo + i), second = _mm_loadu_ps(two[1].lo + i);
        const __m128 lower = _mm_unpacklo_ps(first, second), upper = _mm_unpackhi_ps(first, second);
        numbers.of[i] = _mm_cvtps_pd(lower);
        numbers.of[i + 1] = _mm_cvtps_pd(_mm_movehl_ps(lower, lower));
        numbers.of[i + 2] = _mm_cvtps_pd(upper);
        numbers.of[i + 3] = _mm_cvtps_pd(_mm_movehl_ps(upper, upper));
    }
    return numbers;
}

}  // namespace

std::array<double, 2> importances(const LightTree::Node* two, const LitPoint& at) {
    const NodeNumbers numbers = numbers_of(two);
    const auto& [lo_x, lo_y, lo_z, hi_x, hi_y, hi_z, axis_x, axis_y, axis_z, spread, reach,
                 intensity] = numbers.of;
    const Pair half = both(0.5);
    const Pair x = half * (lo_x + hi_x) - both(at.point.x);
    const Pair y = half * (lo_y + hi_y) - both(at.point.y);
    const Pair z = half * (lo_z + hi_z) - both(at.point.z);
    const Pair size_x = hi_x - lo_x, size_y = hi_y - lo_y, size_z = hi_z - lo_z;
    const Pair radius2 = both(0.25) * (size_x * size_x + size_y * size_y + size_z * size_z);
    const Pair true_squared = x * x + y * y + z * z;
    // Inside the sphere around the node all directions are possible.
    const Pair outside = _mm_cmpgt_pd(true_squared, radius2);
    const Pair squared = chosen(outside, true_squared, both(1.0));
    const Pair distance = _mm_sqrt_pd(squared);
    const Pair to_x = x / distance, to_y = y / distance, to_z = z / distance;
    const Pair sine_b = smaller(_mm_sqrt_pd(radius2) / distance, both(1.0));
    const Pair cosine_b = _mm_sqrt_pd(both(1.0) - sine_b * sine_b);

    Pair cosine_w = _mm_xor_pd(both(-0.0), axis_x * to_x + axis_y * to_y + axis_z * to_z);
    const Pair two_sided = _mm_castsi128_pd(
        _mm_set_epi64x(-std::int64_t{two[1].two_sided}, -std::int64_t{two[0].two_sided}));
    cosine_w = clamped_cosine(chosen(two_sided, magnitude(cosine_w), cosine_w));
    const Pair sine_w = sine_of(cosine_w), sine_o = sine_of(spread);
    const Pair cosine_x = cosine_of_difference(cosine_w, sine_w, spread, sine_o);
    const Pair sine_x = sine_of_difference(cosine_w, sine_w, spread, sine_o);
    const Pair cosine_out = cosine_of_difference(cosine_x, sine_x, cosine_b, sine_b);
    // Lights other than surfaces have no cosine.
    const Pair sent = chosen(_mm_cmplt_pd(reach, both(0.0)), both(1.0), cosine_out);
    Pair result = intensity * sent;
    Pair none = _mm_cmple_pd(cosine_out, reach);
    if (!at.in_volume) {
        Pair cosine_i =
            both(at.normal.x) * to_x + both(at.normal.y) * to_y + both(at.normal.z) * to_z;
        if (at.both_sides) cosine_i = magnitude(cosine_i);
        cosine_i = clamped_cosine(cosine_i);
        const Pair received = cosine_of_difference(cosine_i, sine_of(cosine_i), cosine_b, sine_b);
        none = _mm_or_pd(none, _mm_cmpngt_pd(received, both(0.0)));
        result = result * received;
    }
    result = _mm_andnot_pd(none, result / squared);
    result = chosen(outside, result, intensity / larger(both(1e-300), radius2));
    std::array<double, 2> out;
    _mm_storeu_pd(out.data(), result);
    return out;
}

#else

std::array<double, 2> importances(const LightTree::Node* two, const LitPoint& at) {
    return {importance(two[0], at), importance(two[1], at)};
}

#endif

}  // namespace alhazen
