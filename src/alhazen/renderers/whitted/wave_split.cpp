#include "alhazen/renderers/whitted/wave_split.h"

#include <algorithm>

#include "alhazen/renderers/core/local_shading.h"
#include "alhazen/shading/bsdf/dispersing.h"
#include "alhazen/shading/spectrum/color_matching.h"

namespace alhazen {

WaveSplit::WaveSplit(int count) : waves_(static_cast<std::size_t>(count)) {
    constexpr int kParts = 256;  // per wavelength
    Rgb white;
    for (std::size_t k = 0; k < waves_.size(); ++k) {
        Wave& wave = waves_[k];
        Rgb color;
        for (int i = 0; i < kParts; ++i) {
            const double u = (static_cast<double>(k) + (i + 0.5) / kParts) / count;
            const DrawnWave drawn = draw_wave(u);
            wave.nm += drawn.nm / kParts;
            color += drawn.white * drawn.color;
        }
        for (int c = 0; c < 3; ++c) wave.weight[c] = std::max(0.0, color[c]);
        white += wave.weight;
    }
    for (Wave& wave : waves_) {
        for (int c = 0; c < 3; ++c) wave.weight[c] /= white[c];
    }
}

double eta_by_wave(const Scene& scene, const ShadingPoint& point, double nm) {
    const double air = scene.conventions.shading.air_index;
    const Surface& surface = point.surface;
    const auto index = [&](MaterialId id, double index_d) {
        return index_at(scene.materials[static_cast<std::size_t>(id)], index_d, nm);
    };
    if (point.behind.known) {
        const auto side = [&](const std::optional<MaterialId>& id) {
            return id ? index(*id, medium_at(scene, surface, *id).index) : air;
        };
        return side(surface.media.before) / side(surface.media.after);
    }
    const double own = index(volume_material(surface), point.material->index);
    return point.entering ? air / own : own / air;
}

}  // namespace alhazen
