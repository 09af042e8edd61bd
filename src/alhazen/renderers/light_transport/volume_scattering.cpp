#include "alhazen/renderers/light_transport/volume_scattering.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "alhazen/math/constants.h"
#include "alhazen/renderers/light_transport/shading_frame.h"

namespace alhazen {

double henyey_greenstein(double cosine, double anisotropy) {
    const double g = anisotropy;
    const double squared = std::max(1.0 + g * g - 2.0 * g * cosine, 1e-12);
    return (1.0 - g * g) / (4.0 * kPi * squared * std::sqrt(squared));
}

Vec3 sample_henyey_greenstein(const Vec3& direction, double anisotropy, const Vec2& u) {
    constexpr double kIsotropic = 1e-6;  // below this the formula loses digits
    const double g = anisotropy;
    double cosine = 2.0 * u.x - 1.0;
    if (std::abs(g) > kIsotropic) {
        const double share = (1.0 - g * g) / (1.0 - g + 2.0 * g * u.x);
        cosine = std::clamp((1.0 + g * g - share * share) / (2.0 * g), -1.0, 1.0);
    }
    const double sine = std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
    const double turn = 2.0 * kPi * u.y;
    const ShadingFrame frame = ShadingFrame::of(direction, {});
    return normalize(frame.to_world({sine * std::cos(turn), sine * std::sin(turn), cosine}));
}

VolumeStep step_in_volume(const Spectrum& absorption, const Spectrum& scattering,
                          const Spectrum& throughput, double length, const Vec2& u) {
    const Spectrum extinction = absorption + scattering;
    Spectrum chances;
    double sum = 0.0;
    for (int i = 0; i < Spectrum::kCount; ++i) sum += chances[i] = std::max(throughput[i], 0.0);
    chances = sum > 0.0 ? (1.0 / sum) * chances : Spectrum::all(1.0 / Spectrum::kCount);
    int chosen = 0;
    double above = chances[0];
    while (chosen + 1 < Spectrum::kCount && !(u.x < above)) above += chances[++chosen];
    // Rounding may select a channel of probability 0.
    while (chosen > 0 && chances[chosen] == 0.0) --chosen;
    const double distance = extinction[chosen] > 0.0 ? -std::log1p(-u.y) / extinction[chosen]
                                                     : std::numeric_limits<double>::infinity();
    VolumeStep step{distance < length, std::min(distance, length), {}, {}};
    const Spectrum left = transmittance(extinction, step.distance);
    double density = 0.0;
    for (int i = 0; i < Spectrum::kCount; ++i) {
        density += chances[i] * (step.scatters ? extinction[i] * left[i] : left[i]);
    }
    if (!(density > 0.0)) return step;
    step.weight = (1.0 / density) * (step.scatters ? scattering * left : left);
    if (step.scatters) step.arrived = (1.0 / density) * left;
    return step;
}

}  // namespace alhazen
