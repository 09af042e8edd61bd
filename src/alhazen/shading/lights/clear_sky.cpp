#include "alhazen/shading/lights/clear_sky.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "alhazen/math/constants.h"

namespace alhazen {

namespace {

// Kilometres.
constexpr double kGround = 6360.0, kTop = 6460.0, kEye = 0.002;
constexpr double kRayleighHeight = 8.0, kMieHeight = 1.2;
constexpr Rgb kRayleigh{5.802e-3, 13.558e-3, 33.1e-3};
constexpr Rgb kOzone{0.650e-3, 1.881e-3, 0.085e-3};
constexpr double kMieAlbedo = 0.9, kMieForward = 0.8;

Rgb exp_of(const Rgb& x) {
    return {std::exp(x.r), std::exp(x.g), std::exp(x.b)};
}
Rgb quotient(const Rgb& a, const Rgb& b) {
    return {a.r / b.r, a.g / b.g, a.b / b.b};
}

/// Distance along a ray from radius r, with cosine mu to the zenith, to the ground or else to the
/// enclosing sphere; the flag is true for the ground.
struct Way {
    double length;
    bool to_ground;
};
Way way_of(double r, double mu) {
    const double across = r * r * (mu * mu - 1.0), ground = across + kGround * kGround;
    if (mu < 0.0 && ground > 0.0) {
        return {std::max(0.0, -r * mu - std::sqrt(ground)), true};
    }
    return {-r * mu + std::sqrt(std::max(0.0, across + kTop * kTop)), false};
}

double rayleigh_phase(double cosine) {
    return 3.0 / (16.0 * kPi) * (1.0 + cosine * cosine);
}
/// Cornette-Shanks phase function.
double mie_phase(double cosine) {
    constexpr double g = kMieForward;
    const double k = 3.0 / (8.0 * kPi) * (1.0 - g * g) / (2.0 + g * g);
    return k * (1.0 + cosine * cosine) / std::pow(1.0 + g * g - 2.0 * g * cosine, 1.5);
}

class Atmosphere {
  public:
    Atmosphere(double turbidity, const Rgb& ground) : ground_(ground) {
        // Relative to the vertical optical depth of the molecules in green.
        mie_ = (turbidity - 1.0) * kRayleigh.g * kRayleighHeight / kMieHeight;
        make_transmittance();
        make_multiple();
    }

    /// Transmittance to the top of the atmosphere; 0 if the ray meets the ground.
    [[nodiscard]] Rgb transmittance(double r, double mu) const {
        if (way_of(r, mu).to_ground) return {};
        return lookup(transmittance_, kHeights, kCosines, height_share(r), 0.5 * mu + 0.5);
    }

    /// Radiance along `view` (zenith at z) at a radius, for a sun of irradiance 1.
    [[nodiscard]] Rgb radiance(const Vec3& view, const Vec3& to_sun) const {
        constexpr int kSteps = 32;
        const double r = kGround + kEye, mu = view.z;
        const Way way = way_of(r, mu);
        const double cosine = dot(view, to_sun);
        const double rayleigh = rayleigh_phase(cosine), mie = mie_phase(cosine);
        Rgb through{1, 1, 1}, sum;
        double before = 0.0;
        for (int i = 0; i < kSteps; ++i) {
            // Step sizes increase with the distance.
            const double share = (i + 1.0) / kSteps, end = way.length * share * share;
            const double t = 0.5 * (before + end), step = end - before;
            before = end;
            const Vec3 at = Vec3{0, 0, r} + t * view;
            const Medium m = medium(length(at));
            const double sun = dot(at, to_sun) / length(at);
            const Rgb lit = transmittance(length(at), sun) *
                            (rayleigh * m.rayleigh + (mie * m.mie) * Rgb{1, 1, 1});
            const Rgb more = multiple(length(at), sun) * (m.rayleigh + m.mie * Rgb{1, 1, 1});
            const Rgb passes = exp_of(-step * m.extinction);
            sum += through * quotient((lit + more) * (Rgb{1, 1, 1} - passes), m.extinction);
            through = through * passes;
        }
        return sum;
    }

  private:
    static constexpr int kHeights = 48, kCosines = 384, kFewHeights = 16, kFewCosines = 32;

    struct Medium {
        Rgb rayleigh;  ///< scattering coefficient
        double mie;    ///< scattering coefficient
        Rgb extinction;
    };
    [[nodiscard]] Medium medium(double r) const {
        const double h = std::max(0.0, r - kGround);
        Medium m;
        m.rayleigh = std::exp(-h / kRayleighHeight) * kRayleigh;
        const double mie = mie_ * std::exp(-h / kMieHeight);
        m.mie = kMieAlbedo * mie;
        const double ozone = std::max(0.0, 1.0 - std::abs(h - 25.0) / 15.0);
        m.extinction = m.rayleigh + mie * Rgb{1, 1, 1} + ozone * kOzone;
        return m;
    }

    /// Denser near the ground.
    static double height_share(double r) {
        return std::sqrt(std::clamp((r - kGround) / (kTop - kGround), 0.0, 1.0));
    }
    static double radius_of(double share) { return kGround + share * share * (kTop - kGround); }

    static Rgb lookup(const std::vector<Rgb>& table, int rows, int columns, double row,
                      double column) {
        const double y = std::clamp(row, 0.0, 1.0) * (rows - 1);
        const double x = std::clamp(column, 0.0, 1.0) * (columns - 1);
        const int j = std::min(static_cast<int>(y), rows - 2);
        const int i = std::min(static_cast<int>(x), columns - 2);
        const auto at = [&](int a, int b) { return table[std::size_t(b * columns + a)]; };
        const double fx = x - i, fy = y - j;
        return (1.0 - fy) * ((1.0 - fx) * at(i, j) + fx * at(i + 1, j)) +
               fy * ((1.0 - fx) * at(i, j + 1) + fx * at(i + 1, j + 1));
    }

    void make_transmittance() {
        constexpr int kSteps = 40;
        for (int j = 0; j < kHeights; ++j) {
            const double r = radius_of(double(j) / (kHeights - 1));
            for (int i = 0; i < kCosines; ++i) {
                const double mu = 2.0 * i / (kCosines - 1) - 1.0;
                // Continues through the ground, so that the table is smooth at the horizon.
                const double step =
                    (-r * mu + std::sqrt(r * r * (mu * mu - 1.0) + kTop * kTop)) / kSteps;
                Rgb depth;
                for (int k = 0; k < kSteps; ++k) {
                    const double t = (k + 0.5) * step;
                    depth += step * medium(std::sqrt(r * r + t * t + 2.0 * r * t * mu)).extinction;
                }
                transmittance_.push_back(exp_of(-1.0 * depth));
            }
        }
    }

    [[nodiscard]] Rgb multiple(double r, double sun) const {
        return lookup(multiple_, kFewHeights, kFewCosines, height_share(r), 0.5 * sun + 0.5);
    }

    /// Light scattered twice or more, for a sun of irradiance 1, per scattering coefficient.
    void make_multiple() {
        for (int j = 0; j < kFewHeights; ++j) {
            const double r = std::max(kGround + 1e-3, radius_of(double(j) / (kFewHeights - 1)));
            for (int i = 0; i < kFewCosines; ++i) {
                const double sun = 2.0 * i / (kFewCosines - 1) - 1.0;
                multiple_.push_back(multiple_at(r, sun));
            }
        }
    }

    [[nodiscard]] Rgb multiple_at(double r, double sun) const {
        constexpr int kGrid = 8, kSteps = 16;
        const Vec3 to_sun{std::sqrt(std::max(0.0, 1.0 - sun * sun)), 0, sun};
        Rgb second, share;  // scattered twice; rescattered share of a unit of light
        for (int n = 0; n < kGrid * kGrid; ++n) {
            const double z = 1.0 - 2.0 * (n / kGrid + 0.5) / kGrid;
            const double angle = 2.0 * kPi * (n % kGrid + 0.5) / kGrid;
            const double across = std::sqrt(1.0 - z * z);
            const Vec3 d{across * std::cos(angle), across * std::sin(angle), z};
            const Way way = way_of(r, z);
            const double step = way.length / kSteps;
            Rgb through{1, 1, 1};
            for (int k = 0; k < kSteps; ++k) {
                const Vec3 at = Vec3{0, 0, r} + (k + 0.5) * step * d;
                const double radius = length(at);
                const Medium m = medium(radius);
                const Rgb passes = exp_of(-step * m.extinction);
                const Rgb scatters = m.rayleigh + m.mie * Rgb{1, 1, 1};
                const Rgb here =
                    through * quotient(scatters * (Rgb{1, 1, 1} - passes), m.extinction);
                second +=
                    1.0 / (4.0 * kPi) * here * transmittance(radius, dot(at, to_sun) / radius);
                share += here;
                through = through * passes;
            }
            if (!way.to_ground) continue;
            const Vec3 at = Vec3{0, 0, r} + way.length * d;
            const double cosine = dot(at, to_sun) / length(at);
            if (cosine > 0.0) {
                second += cosine / kPi * through * ground_ * transmittance(kGround + 1e-3, cosine);
            }
        }
        const double mean = 1.0 / (kGrid * kGrid);
        // Isotropic: of a radiance L from all directions, 1/(4 pi) * 4 pi L = L is scattered on.
        return quotient(mean * second, Rgb{1, 1, 1} - mean * share);
    }

    Rgb ground_;
    double mie_ = 0;
    std::vector<Rgb> transmittance_, multiple_;
};

Vec3 direction_of_texel(int x, int y, int width, int height) {
    const double angle = 2.0 * kPi * ((x + 0.5) / width - 0.5), polar = kPi * (y + 0.5) / height;
    return {std::sin(polar) * std::sin(angle), std::sin(polar) * std::cos(angle), std::cos(polar)};
}

void set_texel(Image& image, int x, int y, const Rgb& c) {
    for (int k = 0; k < 3; ++k) image.pixel(x, y)[k] = static_cast<float>(c[k]);
}

}  // namespace

ClearSky clear_sky(const Vec3& to_sun, double turbidity, const Rgb& ground) {
    constexpr int kWidth = 256, kHeight = 256;  // many rows, to resolve the horizon
    const Atmosphere air(turbidity, ground);
    ClearSky sky{Image(kWidth, kHeight, 3), {}};
    const double r = kGround + kEye;
    const Rgb sun = kSunIrradiance * air.transmittance(r, to_sun.z);
    Rgb irradiance = std::max(0.0, to_sun.z) * sun;
    for (int y = 0; y < kHeight / 2; ++y) {
        const double rows = std::cos(kPi * y / kHeight) - std::cos(kPi * (y + 1) / kHeight);
        const double solid = 2.0 * kPi / kWidth * rows;
        for (int x = 0; x < kWidth; ++x) {
            const Vec3 view = direction_of_texel(x, y, kWidth, kHeight);
            const Rgb c = kSunIrradiance * air.radiance(view, to_sun);
            irradiance += (solid * view.z) * c;
            set_texel(sky.picture, x, y, c);
        }
    }
    for (int y = kHeight / 2; y < kHeight; ++y) {
        for (int x = 0; x < kWidth; ++x) {
            set_texel(sky.picture, x, y, (1.0 / kPi) * ground * irradiance);
        }
    }
    if (to_sun.z > 0.0) sky.sun_radiance = 1.0 / (2.0 * kPi * (1.0 - std::cos(kSunRadius))) * sun;
    return sky;
}

}  // namespace alhazen
