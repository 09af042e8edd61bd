#pragma once
/// Which media of a scene scatter light, and what a medium takes from a ray.

#include "alhazen/renderers/light_transport/medium_stack.h"
#include "alhazen/scene/scene.h"
#include "alhazen/shading/spectrum/wavelengths.h"

namespace alhazen {

/// What a medium takes from light that goes straight on. The parts become wavelengths apart, as
/// those of paths do.
struct Extinction {
    Rgb absorbed, scattered;

    Extinction() = default;
    Extinction(const Rgb& absorption)  // NOLINT(google-explicit-constructor)
        : absorbed(absorption) {}
    Extinction(const Rgb& absorption, const Rgb& scattering)
        : absorbed(absorption), scattered(scattering) {}

    [[nodiscard]] bool is_black() const { return absorbed.is_black() && scattered.is_black(); }
    [[nodiscard]] Spectrum of(const Wavelengths& waves) const {
        const Spectrum left = waves.absorption(absorbed);
        return scattered.is_black() ? left : left + waves.absorption(scattered);
    }
};

class ScatteringMedia {
  public:
    explicit ScatteringMedia(const Scene& scene) : scene_(scene) {}

    /// Whether some medium does.
    [[nodiscard]] bool any() const { return scene_.has_scattering; }
    /// Of a medium; null: it does not.
    [[nodiscard]] const VolumeScattering* in(const Medium& medium) const {
        if (!any()) return nullptr;
        const VolumeScattering& scattering = scene_.materials[medium.material].scattering;
        return scattering.coefficient.is_black() ? nullptr : &scattering;
    }
    /// Of a shadow ray. Null: outside all.
    [[nodiscard]] Extinction extinction(const Medium* medium) const {
        if (medium == nullptr) return {};
        const VolumeScattering* const scattering = in(*medium);
        if (scattering == nullptr) return medium->absorption;
        return {medium->absorption, scattering->coefficient};
    }

  private:
    const Scene& scene_;
};

}  // namespace alhazen
