#include "alhazen/shading/spectrum/color_matching.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace alhazen {

namespace {

/// Source: CIE 15:2004, "Colorimetry", table T.4: the standard observer of 1931, every 5 nm from
/// 380 nm on.
constexpr double kX[] = {
    0.001368,   0.002236,   0.004243,   0.00765,    0.01431,    0.02319,    0.04351,    0.07763,
    0.13438,    0.21477,    0.2839,     0.3285,     0.34828,    0.34806,    0.3362,     0.3187,
    0.2908,     0.2511,     0.19536,    0.1421,     0.09564,    0.05795001, 0.03201,    0.0147,
    0.0049,     0.0024,     0.0093,     0.0291,     0.06327,    0.1096,     0.1655,     0.2257499,
    0.2904,     0.3597,     0.4334499,  0.5120501,  0.5945,     0.6784,     0.7621,     0.8425,
    0.9163,     0.9786,     1.0263,     1.0567,     1.0622,     1.0456,     1.0026,     0.9384,
    0.8544499,  0.7514,     0.6424,     0.5419,     0.4479,     0.3608,     0.2835,     0.2187,
    0.1649,     0.1212,     0.0874,     0.0636,     0.04677,    0.0329,     0.0227,     0.01584,
    0.01135916, 0.00811092, 0.00579035, 0.00410946, 0.00289933, 0.00204919, 0.00143997, 0.00099995,
    0.00069008, 0.00047602, 0.0003323,  0.00023483, 0.00016615, 0.00011741, 8.308e-05,  5.871e-05,
    4.151e-05,
};
constexpr double kY[] = {
    3.9e-05,   6.4e-05,   0.00012,  0.000217, 0.000396,  0.00064,  0.00121, 0.00218,   0.004,
    0.0073,    0.0116,    0.01684,  0.023,    0.0298,    0.038,    0.048,   0.06,      0.0739,
    0.09098,   0.1126,    0.13902,  0.1693,   0.20802,   0.2586,   0.323,   0.4073,    0.503,
    0.6082,    0.71,      0.7932,   0.862,    0.9148501, 0.954,    0.9803,  0.9949501, 1.0,
    0.995,     0.9786,    0.952,    0.9154,   0.87,      0.8163,   0.757,   0.6949,    0.631,
    0.5668,    0.503,     0.4412,   0.381,    0.321,     0.265,    0.217,   0.175,     0.1382,
    0.107,     0.0816,    0.061,    0.04458,  0.032,     0.0232,   0.017,   0.01192,   0.00821,
    0.005723,  0.004102,  0.002929, 0.002091, 0.001484,  0.001047, 0.00074, 0.00052,   0.0003611,
    0.0002492, 0.0001719, 0.00012,  8.48e-05, 6e-05,     4.24e-05, 3e-05,   2.12e-05,  1.499e-05,
};
constexpr double kZ[] = {
    0.00645,   0.01054999, 0.02005001, 0.03621, 0.06785001, 0.1102,  0.2074, 0.3713,  0.6456,
    1.0390501, 1.3856,     1.62296,    1.74706, 1.7826,     1.77211, 1.7441, 1.6692,  1.5281,
    1.28764,   1.0419,     0.8129501,  0.6162,  0.46518,    0.3533,  0.272,  0.2123,  0.1582,
    0.1117,    0.07824999, 0.05725001, 0.04216, 0.02984,    0.0203,  0.0134, 0.00875, 0.00575,
    0.0039,    0.00275,    0.0021,     0.0018,  0.00165,    0.0014,  0.0011, 0.001,   0.0008,
    0.0006,    0.00034,    0.00024,    0.00019, 0.0001,     5e-05,   3e-05,  2e-05,   1e-05,
    0.0,       0.0,        0.0,        0.0,     0.0,        0.0,     0.0,    0.0,     0.0,
    0.0,       0.0,        0.0,        0.0,     0.0,        0.0,     0.0,    0.0,     0.0,
    0.0,       0.0,        0.0,        0.0,     0.0,        0.0,     0.0,    0.0,     0.0,
};

/// Source: CIE 15:2004, table T.1: D65, every 10 nm from 380 nm on (the values between are linear
/// by its definition), relative to 560 nm.
constexpr double kD65[] = {
    0.499755, 0.546482, 0.827549, 0.91486,  0.934318, 0.866823, 1.04865,  1.17008,  1.17812,
    1.14861,  1.15923,  1.08811,  1.09354,  1.07802,  1.0479,   1.07689,  1.04405,  1.04046,
    1.0,      0.963342, 0.95788,  0.886856, 0.900062, 0.895991, 0.876987, 0.832886, 0.836992,
    0.800268, 0.802146, 0.822778, 0.782842, 0.697213, 0.716091, 0.74349,  0.61604,  0.698856,
    0.75087,  0.635927, 0.464182, 0.668054, 0.633828,
};

constexpr double kResponseStep = 5.0, kWhiteStep = 10.0;
constexpr int kCells = static_cast<int>(kLongestWave - kShortestWave);
static_assert(std::size(kX) == std::size(kZ) && std::size(kX) == kCells / 5 + 1);
static_assert(std::size(kY) == std::size(kX) && std::size(kD65) == kCells / 10 + 1);

/// Linear sRGB of XYZ by IEC 61966-2-1.
Rgb srgb_of(double x, double y, double z) {
    return {3.2404542 * x - 1.5371385 * y - 0.4985314 * z,
            -0.9692660 * x + 1.8760108 * y + 0.0415560 * z,
            0.0556434 * x - 0.2040259 * y + 1.0572252 * z};
}

/// Position in an equidistant table: the entry before, and the fraction of the step to the next.
struct Between {
    std::size_t before;
    double share;
};
Between between(double nm, double step, std::size_t size) {
    const double place =
        std::clamp((nm - kShortestWave) / step, 0.0, static_cast<double>(size - 1));
    const std::size_t before = std::min(static_cast<std::size_t>(place), size - 2);
    return {before, place - static_cast<double>(before)};
}

/// Responses every 5 nm, scaled so that white is 1, and the density of wavelengths by cells of 1
/// nm.
struct Responses {
    std::array<Rgb, std::size(kX)> channels;
    std::array<double, kCells> density{};
    std::array<double, kCells + 1> sums{};  ///< CDF: the density of all cells before
    /// Enough guides that few intervals between two contain a border of cells.
    static constexpr int kGuides = 4096;
    std::array<std::uint16_t, kGuides + 1> guides{};  ///< the cell at k / kGuides
    /// Coefficients of the linear functions within a cell.
    struct Cell {
        double before, after;  ///< CDF at its ends
        double over_density, white, white_change;
        Rgb color, color_change;
    };
    std::array<Cell, kCells> cells{};

    Responses() {
        for (std::size_t i = 0; i < channels.size(); ++i)
            channels[i] = srgb_of(kX[i], kY[i], kZ[i]);
        Rgb white;
        for (int i = 0; i < kCells; ++i) white += d65_at(i) * at(middle(i));
        for (Rgb& c : channels) c = {c.r / white.r, c.g / white.g, c.b / white.b};
        for (int i = 0; i < kCells; ++i) {
            const Rgb c = at(middle(i));
            density[std::size_t(i)] =
                d65_at(i) * (std::abs(c.r) + std::abs(c.g) + std::abs(c.b) + 1e-6);
            sums[std::size_t(i) + 1] = sums[std::size_t(i)] + density[std::size_t(i)];
        }
        const double all = sums.back();
        for (double& d : density) d /= all;
        for (double& s : sums) s /= all;
        int cell = 0;
        for (int k = 0; k <= kGuides; ++k) {
            while (cell + 1 < kCells && sums[std::size_t(cell) + 1] <= double(k) / kGuides) ++cell;
            guides[std::size_t(k)] = static_cast<std::uint16_t>(cell);
        }
        for (int i = 0; i < kCells; ++i) {
            const double from = kShortestWave + i, to = from + 1.0;
            const double over = 1.0 / density[std::size_t(i)];
            const double white_from = white_light(from), white_to = white_light(to);
            cells[std::size_t(i)] = {sums[std::size_t(i)],
                                     i + 1 < kCells ? sums[std::size_t(i) + 1] : 1.0,
                                     over,
                                     white_from,
                                     white_to - white_from,
                                     over * at(from),
                                     over * (at(to) - at(from))};
        }
    }
    /// `u` in [0, 1), which is below the CDF after the last cell.
    [[nodiscard]] DrawnWave drawn(double u) const {
        const Cell* cell = &cells[guides[static_cast<std::size_t>(u * kGuides)]];
        while (cell->after <= u) ++cell;
        const double share = std::clamp((u - cell->before) * cell->over_density, 0.0, 1.0);
        return {kShortestWave + static_cast<double>(cell - cells.data()) + share,
                cell->white + share * cell->white_change, cell->color + share * cell->color_change};
    }
    [[nodiscard]] static double middle(int cell) { return kShortestWave + cell + 0.5; }
    [[nodiscard]] static double d65_at(int cell) { return white_light(middle(cell)); }
    [[nodiscard]] Rgb at(double nm) const {
        const Between b = between(nm, kResponseStep, channels.size());
        return (1.0 - b.share) * channels[b.before] + b.share * channels[b.before + 1];
    }
};

const Responses& responses() {
    static const Responses all;
    return all;
}

}  // namespace

double white_light(double nm) {
    const Between b = between(nm, kWhiteStep, std::size(kD65));
    return (1.0 - b.share) * kD65[b.before] + b.share * kD65[b.before + 1];
}

Rgb response(double nm) {
    return responses().at(nm);
}

double luminance_response(double nm) {
    const Between b = between(nm, kResponseStep, std::size(kY));
    static const double white = [] {
        double sum = 0.0;
        for (int i = 0; i < kCells; ++i) {
            const double middle = Responses::middle(i);
            const Between m = between(middle, kResponseStep, std::size(kY));
            sum +=
                white_light(middle) * ((1.0 - m.share) * kY[m.before] + m.share * kY[m.before + 1]);
        }
        return sum;
    }();
    return ((1.0 - b.share) * kY[b.before] + b.share * kY[b.before + 1]) / white;
}

DrawnWaves draw_waves(double u) {
    const Responses& all = responses();
    DrawnWaves waves;
    for (int i = 0; i < Spectrum::kCount; ++i) {
        const double shifted = u + static_cast<double>(i) / Spectrum::kCount;
        const DrawnWave wave = all.drawn(shifted < 1.0 ? shifted : shifted - 1.0);
        waves.nm[i] = wave.nm;
        waves.white[i] = wave.white;
        waves.color[static_cast<std::size_t>(i)] = wave.color;
    }
    return waves;
}

DrawnWave draw_wave(double u) {
    return responses().drawn(u);
}

}  // namespace alhazen
