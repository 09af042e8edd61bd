#pragma once
/// Which media of a scene scatter light.

#include "alhazen/renderers/light_transport/medium_stack.h"
#include "alhazen/scene/scene.h"

namespace alhazen {

class ScatteringMedia {
  public:
    explicit ScatteringMedia(const Scene& scene) : scene_(scene) {
        for (const Material& m : scene.materials) any_ |= !m.scattering.coefficient.is_black();
    }

    /// Whether some medium does.
    [[nodiscard]] bool any() const { return any_; }
    /// Of a medium; null: it does not.
    [[nodiscard]] const VolumeScattering* in(const Medium& medium) const {
        if (!any_) return nullptr;
        const VolumeScattering& scattering = scene_.materials[medium.material].scattering;
        return scattering.coefficient.is_black() ? nullptr : &scattering;
    }
    /// What takes light from a shadow ray: absorption, and scattering away. Null: outside all.
    [[nodiscard]] Rgb extinction(const Medium* medium) const {
        if (medium == nullptr) return {};
        const VolumeScattering* const scattering = in(*medium);
        return scattering == nullptr ? medium->absorption
                                     : medium->absorption + scattering->coefficient;
    }

  private:
    const Scene& scene_;
    bool any_ = false;
};

}  // namespace alhazen
