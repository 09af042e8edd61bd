#pragma once
/// Checks for all BSDFs, and a BSDF of each lobe.

#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "alhazen/sampling/random.h"
#include "alhazen/sampling/sobol.h"
#include "alhazen/shading/bsdf/bsdf.h"
#include "alhazen/shading/microfacets/local_directions.h"
#include "support/chi_square.h"

namespace alhazen::testing {

/// A view direction with this cosine to the normal.
inline Vec3 view_at(double cosine, double turn = 0.4) {
    const double s = std::sqrt(1.0 - cosine * cosine);
    return {s * std::cos(turn), s * std::sin(turn), cosine};
}

/// Scrambled Sobol points of three coordinates, the same for all BSDFs.
inline std::span<const std::array<double, 3>> furnace_points(int count) {
    static std::vector<std::array<double, 3>> points;
    for (auto i = static_cast<std::uint32_t>(points.size()); int(i) < count; ++i) {
        points.push_back(
            {scrambled_sobol(7, i, 0), scrambled_sobol(7, i, 1), scrambled_sobol(7, i, 2)});
    }
    return std::span(points).first(static_cast<std::size_t>(count));
}

/// White-furnace test: light to `view` from surroundings of radiance 1 times the square of their
/// index.
inline Spectrum furnace(const Bsdf& bsdf, const Vec3& view, int samples = 1 << 15) {
    Spectrum sum;
    for (const auto& [choice, u, v] : furnace_points(samples)) {
        const auto sample = bsdf.sample(view, choice, {u, v}, Transport::Radiance);
        // Behind a boundary, radiance is larger by the square of the index.
        if (sample) sum += sample->eta * sample->eta * sample->weight;
    }
    return (1.0 / samples) * sum;
}

/// A random direction, uniform on the sphere.
inline Vec3 any_direction(RandomStream& random) {
    const double z = random.uniform(-1, 1), turn = random.uniform(0, 2.0 * kPi);
    const double s = std::sqrt(1.0 - z * z);
    return {s * std::cos(turn), s * std::sin(turn), z};
}

/// Chi-square probability that the sampled directions of `bsdf` follow its density.
inline double sample_probability(const Bsdf& bsdf, const Vec3& view, std::uint64_t seed,
                                 std::size_t samples = 200000) {
    RandomStream random(seed);
    std::vector<std::size_t> counts(SphereCells::kCount);
    std::size_t singular = 0;
    for (std::size_t i = 0; i < samples; ++i) {
        const double choice = random.uniform();
        const Vec2 u{random.uniform(), random.uniform()};
        const auto sample = bsdf.sample(view, choice, u, Transport::Radiance);
        if (!sample) continue;
        if (sample->singular) {
            ++singular;
        } else {
            ++counts[static_cast<std::size_t>(SphereCells::cell_of(sample->direction))];
        }
    }
    auto shares = integrate_cells([&](const Vec3& d) { return bsdf.density(view, d); });
    (void)singular;
    return chi_square_probability(shares, counts, samples);
}

struct NamedBsdf {
    std::string name;
    Bsdf bsdf;
    double error = 1e-3;  ///< relative error of its energy, from tables
};

inline Bsdf bsdf_of_lobe(const Lobe& lobe, const Spectrum& weight = {1, 1, 1, 1}) {
    Bsdf bsdf;
    bsdf.add(weight, lobe);
    return bsdf;
}

/// Every lobe with a density, at several roughnesses; all but sheen have albedo 1.
inline std::vector<NamedBsdf> lobes_with_density(const std::vector<double>& roughnesses) {
    std::vector<NamedBsdf> list;
    const auto add = [&](std::string name, const Lobe& lobe, double error = 1e-3) {
        list.push_back({std::move(name), bsdf_of_lobe(lobe), error});
    };
    add("Lambert", Lambert{});
    add("Lambert, transmitted", LambertTransmission{});
    for (const double r : roughnesses) {
        const std::string at = ", roughness " + std::to_string(r);
        const double alpha = r * r, exponent = 2.0 / (alpha * alpha) - 2.0;
        add("Oren-Nayar" + at, OrenNayar{{1, 1, 1, 1}, r});
        add("rough mirror" + at, RoughReflection({alpha, alpha}, SchlickTerm{}));
        add("rough sheet" + at, RoughSheet({alpha, alpha}));
        const Ggx grooves{alpha + (1.0 - alpha) * 0.64, alpha};
        add("grooved mirror" + at, RoughReflection(grooves, SchlickTerm{}, {0.6, 0.8}));
        add("grooved sheet" + at, RoughSheet(grooves));
        add("rough glass" + at, RoughDielectric(alpha, 1.0 / 1.5, {1, 1, 1, 1}, {1, 1, 1, 1}));
        add("rough glass from inside" + at, RoughDielectric(alpha, 1.5, {1, 1, 1, 1}, {1, 1, 1, 1}),
            5e-3);
        add("Phong" + at, Phong(exponent), 5e-3);
        add("Blinn-Phong" + at, BlinnPhong(exponent));
    }
    return list;
}

}  // namespace alhazen::testing
