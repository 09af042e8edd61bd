#include "alhazen/shading/optics/dispersion.h"

#include <algorithm>
#include <cctype>
#include <cmath>

namespace alhazen {

namespace {

/// Source: SCHOTT, "Optical Glass Data Sheets" (BK7: N-BK7; F2; SF10; SF11: the glasses with lead);
/// Malitson, "Interspecimen Comparison of the Refractive Index of Fused Silica", JOSA 55, 1965;
/// Daimon and Masumura, "Measurement of the Refractive Index of Distilled Water from the
/// Near-infrared Region to the Ultraviolet Region", Applied Optics 46, 2007 (20 degrees); Peter,
/// "Ueber Brechungsindizes und Absorptionskonstanten des Diamanten zwischen 644 und 226 mu",
/// Zeitschrift fuer Physik 15, 1923.
constexpr NamedGlass kGlasses[] = {
    {"BK7", {{1.03961212, 0.231792344, 1.01046945}, {0.00600069867, 0.0200179144, 103.560653}}},
    {"diamond", {{0.3306, 4.3356}, {0.1750 * 0.1750, 0.1060 * 0.1060}}},
    {"F2", {{1.34533359, 0.209073176, 0.937357162}, {0.00997743871, 0.0470450767, 111.886764}}},
    {"fused_quartz",
     {{0.6961663, 0.4079426, 0.8974794},
      {0.0684043 * 0.0684043, 0.1162414 * 0.1162414, 9.896161 * 9.896161}}},
    {"SF10", {{1.61625977, 0.259229334, 1.07762317}, {0.0127534559, 0.0581983954, 116.60768}}},
    {"SF11", {{1.73848403, 0.311168974, 1.17490871}, {0.0136068604, 0.0615960463, 121.922711}}},
    {"water",
     {{5.684027565e-1, 1.726177391e-1, 2.086189578e-2, 1.130748688e-1},
      {5.101829712e-3, 1.821153936e-2, 2.620722293e-2, 1.069792721e1}}},
};

bool same_letters(std::string_view a, std::string_view b) {
    const auto lower = [](char c) { return std::tolower(static_cast<unsigned char>(c)); };
    return std::ranges::equal(a, b, {}, lower, lower);
}

}  // namespace

double Sellmeier::index(double nm) const {
    const double squared = 1e-6 * nm * nm;
    double sum = 1.0;
    for (std::size_t i = 0; i < strength.size(); ++i) {
        sum += strength[i] * squared / (squared - pole[i]);
    }
    return std::sqrt(sum);
}

double Dispersion::index(double index_d, double nm) const {
    if (!(abbe > 0.0)) return sellmeier.index(nm);
    const auto inverse_square = [](double l) { return 1.0 / (l * l); };
    const double b = (index_d - 1.0) / (abbe * (inverse_square(kLineF) - inverse_square(kLineC)));
    return index_d + b * (inverse_square(nm) - inverse_square(kLineD));
}

std::span<const NamedGlass> named_glasses() {
    return kGlasses;
}

const NamedGlass* find_glass(std::string_view name) {
    const auto* const found = std::ranges::find_if(
        kGlasses, [&](const NamedGlass& glass) { return same_letters(glass.name, name); });
    return found != std::end(kGlasses) ? found : nullptr;
}

}  // namespace alhazen
