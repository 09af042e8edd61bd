#include "alhazen/illumination/light_importance.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

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

/// The importance of a sibling.
double importance_of(const LightTree::Siblings& n, std::size_t i, const LitPoint& at) {
    const Vec3 offset = Vec3{n.center[0][i], n.center[1][i], n.center[2][i]} - at.point;
    const double radius2 = n.radius2[i], squared = length_squared(offset);
    const double intensity = std::abs(n.intensity[i]);
    // Inside the sphere around the node all directions are possible.
    if (!(squared > radius2)) return intensity / std::max(radius2, 1e-300);
    const double distance = std::sqrt(squared);
    const Vec3 to_light = offset / distance;
    const double sine_b = std::min(1.0, std::sqrt(radius2) / distance);
    const double cosine_b = std::sqrt(1.0 - sine_b * sine_b);

    double cosine_w =
        -(n.axis[0][i] * to_light.x + n.axis[1][i] * to_light.y + n.axis[2][i] * to_light.z);
    if (n.intensity[i] < 0.0f) cosine_w = std::abs(cosine_w);
    cosine_w = std::clamp(cosine_w, -1.0, 1.0);
    const double sine_w = sine_of(cosine_w);
    const double cosine_o = n.cosine_spread[i], sine_o = sine_of(cosine_o);
    const double cosine_x = cosine_of_difference(cosine_w, sine_w, cosine_o, sine_o);
    const double sine_x = sine_of_difference(cosine_w, sine_w, cosine_o, sine_o);
    const double cosine_out = cosine_of_difference(cosine_x, sine_x, cosine_b, sine_b);
    if (cosine_out <= n.cosine_reach[i]) return 0.0;
    // Lights other than surfaces have no cosine.
    const double sent = n.cosine_reach[i] < 0.0 ? 1.0 : cosine_out;

    if (at.in_volume) return intensity * sent / squared;
    double cosine_i = dot(at.normal, to_light);
    if (at.both_sides) cosine_i = std::abs(cosine_i);
    cosine_i = std::clamp(cosine_i, -1.0, 1.0);
    const double received = cosine_of_difference(cosine_i, sine_of(cosine_i), cosine_b, sine_b);
    if (!(received > 0.0)) return 0.0;
    return intensity * sent * received / squared;
}

}  // namespace

double importance(const LightTree::Node& n, const LitPoint& at) {
    LightTree::Siblings two{};
    two.set(0, n);
    return importance_of(two, 0, at);
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

/// Two successive pairs of floats as doubles.
struct TwoPairs {
    Pair first, second;
};
TwoPairs two_pairs(const float* floats) {
    const __m128 four = _mm_loadu_ps(floats);
    return {_mm_cvtps_pd(four), _mm_cvtps_pd(_mm_movehl_ps(four, four))};
}

}  // namespace

std::array<double, 2> importances(const LightTree::Siblings& two, const LitPoint& at) {
    const auto number = [](const double(&of)[2]) { return _mm_loadu_pd(of); };
    static_assert(offsetof(LightTree::Siblings, intensity) ==
                  offsetof(LightTree::Siblings, axis) + 10 * sizeof(float));
    const auto [axis_x, axis_y] = two_pairs(two.axis[0]);
    const auto [axis_z, spread] = two_pairs(two.axis[2]);
    const auto [reach, signed_intensity] = two_pairs(two.cosine_reach);
    const Pair x = number(two.center[0]) - both(at.point.x);
    const Pair y = number(two.center[1]) - both(at.point.y);
    const Pair z = number(two.center[2]) - both(at.point.z);
    const Pair radius2 = number(two.radius2), intensity = magnitude(signed_intensity);
    const Pair true_squared = x * x + y * y + z * z;
    // Inside the sphere around the node all directions are possible.
    const Pair outside = _mm_cmpgt_pd(true_squared, radius2);
    const Pair squared = chosen(outside, true_squared, both(1.0));
    const Pair distance = _mm_sqrt_pd(squared);
    const Pair to_x = x / distance, to_y = y / distance, to_z = z / distance;
    const Pair sine_b = smaller(_mm_sqrt_pd(radius2) / distance, both(1.0));
    const Pair cosine_b = _mm_sqrt_pd(both(1.0) - sine_b * sine_b);

    Pair cosine_w = _mm_xor_pd(both(-0.0), axis_x * to_x + axis_y * to_y + axis_z * to_z);
    const Pair two_sided = _mm_cmplt_pd(signed_intensity, both(0.0));
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

std::array<double, 2> importances(const LightTree::Siblings& two, const LitPoint& at) {
    return {importance_of(two, 0, at), importance_of(two, 1, at)};
}

#endif

}  // namespace alhazen
