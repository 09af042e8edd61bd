#pragma once
/// Which media of a scene scatter light, and what a medium takes from a ray.

#include <algorithm>

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

/// Whether the surface may bound a volume: false of opaque ones and thin sheets.
[[nodiscard]] inline bool may_bound_volume(const Material& m) {
    if (m.conductor || m.dielectric) return m.dielectric.has_value();
    if (const auto& p = m.metallic_roughness) {
        return p->transmission.value > 0.0 && p->thickness.value > 0.0;
    }
    return m.transmissive.texture != kNoTexture || !m.transmissive.color.is_black();
}

class ScatteringMedia {
  public:
    explicit ScatteringMedia(const Scene& scene)
        : scene_(scene),
          open_(std::any_of(scene.materials.begin(), scene.materials.end(), [](const Material& m) {
              return m.alpha_mode != AlphaMode::Opaque && may_bound_volume(m);
          })) {}

    /// Whether some medium does.
    [[nodiscard]] bool any() const { return scene_.has_scattering; }
    /// Whether some boundary of a volume may cover in part, and be open for the rest.
    [[nodiscard]] bool has_open_boundaries() const { return open_; }
    /// Whether a straight ray may go through more than one volume.
    [[nodiscard]] bool are_followed() const { return any() || open_; }
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
    bool open_;
};

}  // namespace alhazen
