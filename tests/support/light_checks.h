#pragma once
/// Checks of light sampling against rays: rays hit the lights that `draw` samples, with the same
/// density.

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "alhazen/illumination/illumination.h"
#include "alhazen/math/constants.h"
#include "alhazen/sampling/random.h"

namespace alhazen::testing {

/// Probability of a chi-square sum of `freedom` degrees above `sum`: the upper incomplete gamma
/// function by its series or continued fraction.
inline double chi_square_tail(double sum, double freedom) {
    const double a = 0.5 * freedom, x = 0.5 * sum;
    const double scale = std::exp(-x + a * std::log(x) - std::lgamma(a));
    if (x < a + 1.0) {
        double term = 1.0 / a, series = term;
        for (int n = 1; n < 10000 && term > 1e-16 * series; ++n) series += term *= x / (a + n);
        return 1.0 - scale * series;
    }
    double b = x + 1.0 - a, c = 1e300, d = 1.0 / b, fraction = d;
    for (int i = 1; i < 10000; ++i) {
        const double an = -i * (i - a);
        b += 2.0;
        d = 1.0 / (an * d + b);
        c = b + an / c;
        fraction *= d * c;
        if (std::abs(d * c - 1.0) < 1e-15) break;
    }
    return scale * fraction;
}

/// The density of `draw` for a direction: the sum over all hits of a ray, or, if `distance` is
/// given, that of the hit there.
inline double density_along(const Scene& scene, const Illumination& lights, const LitPoint& at,
                            const Vec3& direction, double distance = -1.0) {
    const Ray ray{at.point, direction};
    std::vector<Hit> hits;
    scene.aggregate->all_hits(ray, hits, {nullptr, mask_of(RayKind::Reflection)});
    double sum = 0.0;
    for (const Hit& hit : hits) {
        if (distance >= 0.0 && !(std::abs(hit.t - distance) < 1e-6 * distance)) continue;
        const Surface surface = surface_at(*scene.aggregate, ray, hit);
        sum += lights.density(at, ray, hit, surface, hit.t);
    }
    if (distance < 0.0 || std::isinf(distance)) sum += lights.environment_density(at, direction);
    return sum;
}

/// Expects that samples of `draw` have the density and the distance of the hit of a ray.
inline void expect_equal_densities(const Scene& scene, const Illumination& lights,
                                   const LitPoint& at, double tolerance = 1e-7, int count = 2000) {
    RandomStream random(7);
    int drawn = 0, missed = 0;
    for (int i = 0; i < count; ++i) {
        const double choice = random.uniform();
        const Vec2 u{random.uniform(), random.uniform()};
        const LightDraw draw = lights.draw(at, choice, u, kColorChannels);
        if (!(draw.density > 0.0)) continue;
        ASSERT_FALSE(draw.singular);
        ASSERT_NEAR(length(draw.to_light), 1.0, 1e-9);
        ++drawn;
        const double found = density_along(scene, lights, at, draw.to_light, draw.distance);
        // A ray to the very edge of a light may miss it.
        if (found == 0.0) {
            ++missed;
            continue;
        }
        EXPECT_NEAR(found / draw.density, 1.0, tolerance) << i << " " << u.x << " " << u.y;
        if (::testing::Test::HasFailure()) return;
    }
    EXPECT_GT(drawn, count / 8);
    EXPECT_LE(missed, drawn / 200);
}

/// The directions around `axis` up to the angle with that cosine.
struct DirectionCone {
    Vec3 axis{0, 0, 1};
    double cosine = -1;
};

/// The chi-square test of `draw` in bins of equal solid angle: the probability of a sum at least as
/// large by chance. Draws outside the cone and empty draws are one more bin.
inline double draw_p_value(const Scene& scene, const Illumination& lights, const LitPoint& at,
                           const DirectionCone& cone, std::uint64_t seed) {
    constexpr int kBins = 12, kDraws = 10000;
    constexpr int kRays = 10;  // along each side of a bin
    const Vec3 x = perpendicular(cone.axis), y = cross(cone.axis, x);
    const auto direction = [&](double u, double v) {
        const double z = 1.0 - u * (1.0 - cone.cosine), angle = 2.0 * kPi * v;
        const double r = std::sqrt(std::max(0.0, 1.0 - z * z));
        return normalize(z * cone.axis + (r * std::cos(angle)) * x + (r * std::sin(angle)) * y);
    };
    std::vector<double> expected(kBins * kBins + 1, 0.0), found(kBins * kBins + 1, 0.0);
    // Integrates by midpoints of cells; if neighbours differ much, of smaller cells.
    const int side = kBins * kRays;
    std::vector<double> coarse(std::size_t(side * side));
    const auto at_cell = [&](double i, double j) {
        return density_along(scene, lights, at, direction(i / side, j / side));
    };
    for (int i = 0; i < side; ++i) {
        for (int j = 0; j < side; ++j)
            coarse[std::size_t(i * side + j)] = at_cell(i + 0.5, j + 0.5);
    }
    const auto differs = [&](int i, int j) {
        const double here = coarse[std::size_t(i * side + j)];
        for (int n = 0; n < 9; ++n) {
            const int k = std::clamp(i + n / 3 - 1, 0, side - 1), m = (j + n % 3 - 1 + side) % side;
            const double there = coarse[std::size_t(k * side + m)];
            if (std::abs(there - here) > 0.1 * (there + here)) return true;
        }
        return false;
    };
    const double solid = 2.0 * kPi * (1.0 - cone.cosine) / (side * side);
    double rest = 1.0;
    for (int i = 0; i < side; ++i) {
        for (int j = 0; j < side; ++j) {
            double mean = coarse[std::size_t(i * side + j)];
            if (i < 4 || differs(i, j)) {  // cells at the axis are long
                constexpr int kFine = 8;
                mean = 0.0;
                for (int n = 0; n < kFine * kFine; ++n) {
                    mean += at_cell(i + (n / kFine + 0.5) / kFine, j + (n % kFine + 0.5) / kFine) /
                            (kFine * kFine);
                }
            }
            expected[std::size_t(i / kRays * kBins + j / kRays)] += kDraws * solid * mean;
            rest -= solid * mean;
        }
    }
    expected.back() = kDraws * std::max(0.0, rest);
    RandomStream random(seed);
    for (int i = 0; i < kDraws; ++i) {
        const double choice = random.uniform();
        const Vec2 u{random.uniform(), random.uniform()};
        const LightDraw draw = lights.draw(at, choice, u, kColorChannels);
        std::size_t bin = kBins * kBins;
        const double z = dot(draw.to_light, cone.axis);
        if (draw.density > 0.0 && z > cone.cosine) {
            const double a = std::atan2(dot(draw.to_light, y), dot(draw.to_light, x)) / (2.0 * kPi);
            const int row = std::min(int((1.0 - z) / (1.0 - cone.cosine) * kBins), kBins - 1);
            const int column = std::min(int((a < 0.0 ? a + 1.0 : a) * kBins), kBins - 1);
            bin = std::size_t(row * kBins + column);
        }
        found[bin] += 1.0;
    }
    // Bins with few expected samples are pooled.
    double sum = 0.0, few_expected = 0.0, few_found = 0.0;
    int freedom = -1;
    const auto add = [&](double e, double f) {
        sum += (f - e) * (f - e) / e;
        ++freedom;
    };
    for (std::size_t b = 0; b < expected.size(); ++b) {
        if (expected[b] >= 10.0) {
            add(expected[b], found[b]);
        } else {
            few_expected += expected[b];
            few_found += found[b];
        }
    }
    if (few_expected >= 5.0) {
        add(few_expected, few_found);
    } else if (few_found > 5.0 + 10.0 * few_expected) {
        return 0.0;
    }
    return freedom > 0 ? chi_square_tail(sum, freedom) : 1.0;
}

/// The level of each of `tests` tests for a probability of 1e-3 that any fails by chance (Sidak).
inline double sidak_level(int tests) {
    return 1.0 - std::pow(1.0 - 1e-3, 1.0 / tests);
}

/// The irradiance: mean of radiance * cosine / density over unoccluded draws.
inline Spectrum mean_irradiance(const Scene& scene, const Illumination& lights, const LitPoint& at,
                                int draws) {
    RandomStream random(3);
    Spectrum sum;
    for (int i = 0; i < draws; ++i) {
        const double choice = (i + random.uniform()) / draws;
        const Vec2 u{random.uniform(), random.uniform()};
        const LightDraw draw = lights.draw(at, choice, u, kColorChannels);
        const double cosine = dot(at.normal, draw.to_light);
        if (!(draw.density > 0.0) || !(cosine > 0.0)) continue;
        const Ray ray{at.point, draw.to_light, 1e-9,
                      std::isfinite(draw.distance) ? draw.distance * (1.0 - 1e-9) : kInfinity};
        if (scene.aggregate->occluded(ray, {nullptr, mask_of(RayKind::Shadow)})) continue;
        sum += (cosine / draw.density) * draw.radiance;
    }
    return (1.0 / draws) * sum;
}

/// The difference between the irradiance by `draw` and that by cosine-distributed directions, in
/// standard deviations of both together.
inline double irradiance_z(const Scene& scene, const Illumination& lights, const LitPoint& at,
                           int count, std::uint64_t seed) {
    RandomStream random(seed);
    double sums[2] = {}, squares[2] = {};
    const Vec3 x = perpendicular(at.normal), y = cross(at.normal, x);
    for (int i = 0; i < count; ++i) {
        const Vec2 u{random.uniform(), random.uniform()};
        const LightDraw draw = lights.draw(at, random.uniform(), u, kColorChannels);
        const double cosine = dot(at.normal, draw.to_light);
        double drawn = 0.0;
        if (draw.density > 0.0 && cosine > 0.0) {
            const Ray shadow{
                at.point, draw.to_light, 1e-9,
                std::isfinite(draw.distance) ? draw.distance * (1.0 - 1e-7) : kInfinity};
            if (!scene.aggregate->occluded(shadow, {nullptr, mask_of(RayKind::Shadow)})) {
                drawn = cosine / draw.density * draw.radiance.b;
            }
        }
        const double r = std::sqrt(random.uniform()), angle = 2.0 * kPi * random.uniform();
        const Vec3 d = normalize((r * std::cos(angle)) * x + (r * std::sin(angle)) * y +
                                 std::sqrt(1.0 - r * r) * at.normal);
        const Ray ray{at.point, d};
        Hit hit;
        double met = 0.0;
        if (scene.aggregate->closest(ray, hit, {nullptr, mask_of(RayKind::Reflection)})) {
            const Surface surface = surface_at(*scene.aggregate, ray, hit);
            const Material& m = scene.materials[std::size_t(surface.materials[0])];
            const bool seen = m.double_sided || dot(surface.normal, d) < 0.0;
            const SurfaceLookup lookup{{surface.uv, surface.uv2}, {}, surface.color, {}};
            if (seen) met = kPi * evaluate(m, scene.textures, lookup).emission.g;
        } else {
            met = kPi * lights.environment(d, kColorChannels).b;
        }
        sums[0] += drawn;
        sums[1] += met;
        squares[0] += drawn * drawn;
        squares[1] += met * met;
    }
    double variance = 0.0;
    for (int k = 0; k < 2; ++k) {
        const double mean = sums[k] / count;
        variance += (squares[k] / count - mean * mean) / count;
    }
    return (sums[0] - sums[1]) / count / std::sqrt(variance);
}

}  // namespace alhazen::testing
