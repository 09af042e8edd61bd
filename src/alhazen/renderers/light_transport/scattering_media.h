#pragma once
/// The scattering media of a scene, and the extinction of a medium.

#include <algorithm>

#include "alhazen/renderers/volumes/medium_stack.h"
#include "alhazen/renderers/volumes/volume_bounds.h"
#include "alhazen/scene/scene.h"
#include "alhazen/shading/spectrum/wavelengths.h"

namespace alhazen {

/// The extinction of a medium, per unit length. Its parts are converted to wavelengths separately,
/// as in paths.
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
    explicit ScatteringMedia(const Scene& scene)
        : scene_(scene),
          open_(std::any_of(scene.materials.begin(), scene.materials.end(),
                            [](const Material& m) {
                                return m.alpha_mode != AlphaMode::Opaque && has_inside(m);
                            })),
          null_(std::any_of(scene.materials.begin(), scene.materials.end(), [&](const Material& m) {
              return may_be_null_boundary(m, scene.conventions.shading.air_index);
          })) {}

    /// True if some medium scatters.
    [[nodiscard]] bool any() const { return scene_.has_scattering; }
    /// True if some boundary of a volume may have a coverage below 1.
    [[nodiscard]] bool has_open_boundaries() const { return open_; }
    /// True if a surface of the material is a clear thin sheet, or any surface of the scene may be
    /// a null boundary: ScatterPoint::may_be_passed decides.
    [[nodiscard]] bool may_be_passed(const MaterialSample& m) const {
        return any() || null_ || (m.thin && !m.transmissive.is_black());
    }
    /// True if a straight ray may pass through more than one volume.
    [[nodiscard]] bool are_followed() const { return any() || open_ || null_; }
    /// The scattering of a medium; null: none.
    [[nodiscard]] const VolumeScattering* in(const Medium& medium) const {
        if (!any()) return nullptr;
        const VolumeScattering& scattering = scene_.materials[medium.material].scattering;
        return scattering.coefficient.is_black() ? nullptr : &scattering;
    }
    /// The extinction of a medium for a shadow ray. Null: outside all volumes.
    [[nodiscard]] Extinction extinction(const Medium* medium) const {
        if (medium == nullptr) return {};
        const VolumeScattering* const scattering = in(*medium);
        if (scattering == nullptr) return medium->absorption;
        return {medium->absorption, scattering->coefficient};
    }

  private:
    const Scene& scene_;
    bool open_, null_;
};

}  // namespace alhazen
