#include "alhazen/shading/textures/solid_texture.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "alhazen/geometry/cones/disc_area.h"
#include "alhazen/math/constants.h"
#include "alhazen/math/unit_vector.h"

namespace alhazen {

namespace {

/// Coordinates beyond this have no fraction; also keeps NaN and infinity from integer conversion.
double bounded_place(double x) {
    return x > -1e9 && x < 1e9 ? x : 0.0;
}

Vec3 bounded_axis(const Vec3& v) {
    return length_squared(v) < 1e18 ? v : Vec3{1e9, 1e9, 1e9};
}

/// 1 in the cells [2 k, 2 k + 1), -1 in the others.
double square_wave(double x) {
    return std::fmod(std::floor(x), 2.0) == 0.0 ? 1.0 : -1.0;
}

/// Offset towards the cell above, in cells.
constexpr double kAboveFaces = 1e-7;

/// Waves are averaged exactly over at most this many cells; beyond, the mean is grey.
constexpr double kMostCells = 32.0;

/// A coordinate as a function on the unit disc: c + g (s, t).
struct OverDisc {
    double c;
    Vec2 g;
    [[nodiscard]] double reach() const { return std::sqrt(g.x * g.x + g.y * g.y); }
    [[nodiscard]] double first_edge() const { return std::floor(c - reach()) + 1.0; }
    /// Clamped to 1000, far more than are integrated individually.
    [[nodiscard]] int edges() const {
        const double last = std::ceil(c + reach()) - 1.0;
        return static_cast<int>(std::clamp(last - first_edge() + 1.0, 0.0, 1e3));
    }
};

/// The mean of the square wave over the disc.
double stripes_over(const OverDisc& x) {
    const double reach = x.reach();
    if (x.edges() == 0) return square_wave(x.c);
    if (reach > kMostCells) return 0.0;
    // The sign changes at each edge, beginning from the lowest point of the disc.
    double sign = square_wave(x.first_edge() - 0.5), sum = sign * kPi;
    for (double edge = x.first_edge(); edge < x.c + reach; edge += 1.0) {
        sum -= 2.0 * sign * segment_area(1.0, (edge - x.c) / reach);
        sign = -sign;
    }
    return sum / kPi;
}

/// The mean of the product of two square waves whose edges divide the disc into few cells.
double cells_over(const OverDisc& x, const OverDisc& y, double det) {
    const auto bounds = [](const OverDisc& v, int k) {
        if (k == 0) return v.c - 1.01 * v.reach();
        return k <= v.edges() ? v.first_edge() + k - 1 : v.c + 1.01 * v.reach();
    };
    const auto corner = [&](double px, double py) {
        const double dx = px - x.c, dy = py - y.c;
        return Vec2{(dx * y.g.y - dy * x.g.y) / det, (dy * x.g.x - dx * y.g.x) / det};
    };
    double sum = 0.0;
    for (int i = 0; i <= x.edges(); ++i) {
        const double x0 = bounds(x, i), x1 = bounds(x, i + 1);
        for (int j = 0; j <= y.edges(); ++j) {
            const double y0 = bounds(y, j), y1 = bounds(y, j + 1);
            const std::array<Vec2, 4> cell{corner(x0, y0), corner(x1, y0), corner(x1, y1),
                                           corner(x0, y1)};
            sum += square_wave(0.5 * (x0 + x1)) * square_wave(0.5 * (y0 + y1)) *
                   std::abs(loop_part(cell).area);
        }
    }
    return sum / kPi;
}

/// The mean of the product of three square waves along a line from `p` to `q`.
double waves_along(const Vec3& p, const Vec3& q) {
    const Vec3 d = q - p;
    std::array<double, 3> next, step;
    for (int k = 0; k < 3; ++k) {
        const auto i = static_cast<std::size_t>(k);
        step[i] = std::abs(d[k]) > 1e-12 ? 1.0 / std::abs(d[k]) : kInfinity;
        const double inside =
            d[k] > 0.0 ? 1.0 - (p[k] - std::floor(p[k])) : p[k] - std::floor(p[k]);
        next[i] = std::isfinite(step[i]) ? inside * step[i] : kInfinity;
    }
    double sign = square_wave(p.x) * square_wave(p.y) * square_wave(p.z), at = 0.0, sum = 0.0;
    for (;;) {
        std::size_t i = next[0] <= next[1] ? 0 : 1;
        if (next[2] < next[i]) i = 2;
        if (!(next[i] < 1.0)) return sum + sign * (1.0 - at);
        sum += sign * (next[i] - at);
        at = next[i];
        sign = -sign;
        next[i] += step[i];
    }
}

/// Integrates by chords along the longer axis, with Chebyshev's quadrature of the second kind.
double checks_by_chords(const Vec3& center, Vec3 a, Vec3 b) {
    constexpr int kChords = 32;
    if (length_squared(b) > length_squared(a)) std::swap(a, b);
    const double longest = length(a);
    if (longest > kMostCells) a = (kMostCells / longest) * a;
    double sum = 0.0, all = 0.0;
    for (int k = 1; k <= kChords; ++k) {
        const double angle = kPi * k / (kChords + 1);
        const double half = std::sin(angle), weight = half * half;
        const Vec3 middle = center + std::cos(angle) * b;
        sum += weight * waves_along(middle - half * a, middle + half * a);
        all += weight;
    }
    return sum / all;
}

double checks_over(const Vec3& center, const Vec3& a, const Vec3& b) {
    constexpr int kMostExact = 20;
    std::array<OverDisc, 3> crossed{};
    int count = 0;
    double sign = 1.0;
    for (int k = 0; k < 3; ++k) {
        const OverDisc over{center[k], {a[k], b[k]}};
        if (over.edges() == 0) {
            sign *= square_wave(center[k]);
        } else {
            crossed[static_cast<std::size_t>(count++)] = over;
        }
    }
    if (count == 0) return sign;
    if (count == 1) return sign * stripes_over(crossed[0]);
    if (count == 2 && (crossed[0].edges() + 1) * (crossed[1].edges() + 1) <= kMostExact) {
        const OverDisc &x = crossed[0], &y = crossed[1];
        const double det = x.g.x * y.g.y - x.g.y * y.g.x;
        if (std::abs(det) > 1e-3 * x.reach() * y.reach()) return sign * cells_over(x, y, det);
    }
    return checks_by_chords(center, a, b);
}

std::uint32_t mixed_bits(std::uint32_t h) {
    h ^= h >> 16;
    h *= 0x7feb352du;
    h ^= h >> 15;
    h *= 0x846ca68bu;
    return h ^ (h >> 16);
}

/// Dot product of the gradient at a lattice point with the offset from it; Perlin's twelve edges of
/// a cube are the gradients.
double lattice_slope(std::int64_t x, std::int64_t y, std::int64_t z, const Vec3& d) {
    const auto word = [](std::int64_t v) { return static_cast<std::uint32_t>(v); };
    const std::uint32_t h =
        mixed_bits(word(x) + mixed_bits(word(y) + mixed_bits(word(z) + 0x9e3779b9u))) & 15u;
    const double u = h < 8 ? d.x : d.y;
    const double v = h < 4 ? d.y : h == 12 || h == 14 ? d.x : d.z;
    return ((h & 1u) != 0 ? -u : u) + ((h & 2u) != 0 ? -v : v);
}

double fade(double t) {
    return t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
}

/// 2 J1(x) / x: attenuation of a wave averaged over a disc whose radius is x radians of it.
double disc_transform(double x) {
    constexpr double kLargest = 12.0;
    if (!(x < kLargest)) return 0.0;
    const double q = -0.25 * x * x;
    double term = 1.0, sum = 1.0;
    for (int k = 1; k < 40; ++k) {
        term *= q / (static_cast<double>(k) * (k + 1));
        sum += term;
    }
    return sum;
}

/// A sum of octaves of noise; those beyond the resolution of the aperture fade out.
double fractal_noise(const Vec3& p, double aperture, int octaves) {
    double sum = 0.0, amplitude = 1.0, frequency = 1.0;
    for (int k = 0; k < octaves; ++k) {
        // The first zero of the transform of a disc.
        const double x = aperture * frequency / 0.61;
        if (x >= 1.0) break;
        const double left = (1.0 - x * x) * (1.0 - x * x);
        const double shift = 17.0 * k;  // avoids common zeros of the octaves' lattices
        sum += left * amplitude * gradient_noise(frequency * p + Vec3{shift, 0.5 * shift, shift});
        amplitude *= 0.5;
        frequency *= 2.0;
    }
    return sum;
}

/// The weight of `other` in the mix.
double share_of(const SolidTexture& t, const SolidAperture& aperture) {
    Vec3 p = (aperture.point - t.origin) / t.size;
    // A surface in a face between cubes shows the cube above it, whatever the rounding of its
    // points.
    const auto place = [](double x) { return bounded_place(x) + kAboveFaces; };
    p = {place(p.x), place(p.y), place(p.z)};
    const Vec3 a = bounded_axis(aperture.a / t.size), b = bounded_axis(aperture.b / t.size);
    const Vec3 direction = unit_or(t.direction, {0, 0, 1});
    const auto along = [&](const Vec3& d) {
        const double u = dot(a, d), v = dot(b, d);
        return OverDisc{dot(p, d), {u, v}};
    };
    const auto bent = [&](double wavelength_in_sizes) {
        const double width = std::sqrt(0.5 * (length_squared(a) + length_squared(b)));
        return fractal_noise((1.0 / wavelength_in_sizes) * p, width / wavelength_in_sizes,
                             t.octaves);
    };
    switch (t.kind) {
        case SolidTexture::Kind::Checks:
            return 0.5 - 0.5 * checks_over(p, a, b);
        case SolidTexture::Kind::Stripes:
            return 0.5 - 0.5 * stripes_over(along(direction));
        case SolidTexture::Kind::Noise:
            return std::clamp(0.5 + 0.5 * bent(1.0), 0.0, 1.0);
        case SolidTexture::Kind::Marble: {
            const OverDisc x = along(direction);
            return 0.5 - 0.5 * disc_transform(kPi * x.reach()) *
                             std::sin(kPi * (x.c + t.turbulence * bent(2.0)));
        }
        case SolidTexture::Kind::Wood:
            break;
    }
    const Vec3 across = p - dot(p, direction) * direction;
    const double radius = length(across);
    const OverDisc x = along(radius > 0.0 ? across / radius : perpendicular(direction));
    return 0.5 + 0.5 * disc_transform(2.0 * kPi * x.reach()) *
                     std::cos(2.0 * kPi * (radius + t.turbulence * bent(4.0)));
}

}  // namespace

double gradient_noise(const Vec3& p) {
    const Vec3 base{std::floor(p.x), std::floor(p.y), std::floor(p.z)};
    const auto x = static_cast<std::int64_t>(base.x), y = static_cast<std::int64_t>(base.y),
               z = static_cast<std::int64_t>(base.z);
    const Vec3 f = p - base;
    const Vec3 w{fade(f.x), fade(f.y), fade(f.z)};
    double sum = 0.0;
    for (int k = 0; k < 8; ++k) {
        const int i = k & 1, j = k >> 1 & 1, l = k >> 2;
        const double weight =
            (i != 0 ? w.x : 1 - w.x) * (j != 0 ? w.y : 1 - w.y) * (l != 0 ? w.z : 1 - w.z);
        sum +=
            weight * lattice_slope(x + i, y + j, z + l, f - Vec3{double(i), double(j), double(l)});
    }
    return sum;
}

Rgba evaluate(const SolidTexture& texture, const SolidAperture& aperture) {
    const double share = share_of(texture, aperture);
    return (1.0 - share) * texture.color + share * texture.other;
}

}  // namespace alhazen
