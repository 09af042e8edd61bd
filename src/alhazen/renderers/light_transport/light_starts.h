#pragma once
/// Where light paths begin: at what shines, or before all that lies in the way of light from afar.
///
/// Conventions: rays of the environment and of parallel light come from a disc before all that is
/// bounded (Illumination::emit). Where something is endless they begin before its last crossing, so
/// that it reflects, bends or blocks them as it does any light. What comes from afar in a volume
/// without end that takes light is black.
/// Threads: const functions may be called from many.

#include <vector>

#include "alhazen/illumination/illumination.h"
#include "alhazen/renderers/light_transport/media_finder.h"
#include "alhazen/renderers/light_transport/random_walk.h"
#include "alhazen/renderers/light_transport/scattering_media.h"

namespace alhazen {

class LightStarts {
  public:
    explicit LightStarts(const Scene& scene);

    /// The walk of a ray of light. Its throughput is black where it carries nothing.
    [[nodiscard]] WalkStart of(const LightRay& light, float time, const Wavelengths& waves) const;

  private:
    /// Moves the origin back. False where something opaque lies too far away to begin before it:
    /// no light comes through.
    [[nodiscard]] bool begin_before_all(Ray& ray, float time) const;
    /// Moves the beginning of light from afar before all that is endless, into the volumes there.
    void begin_from_infinity(WalkStart& start) const;

    const Scene& scene_;
    MediaFinder media_;
    ScatteringMedia scattering_;
    bool is_endless_;
    double radius_;  ///< of a sphere around what is bounded
};

/// Gives the vertices of a path from a point the light's own falloff over its first distance.
void set_falloff(const Illumination& lights, const LightRay& light, const Wavelengths& waves,
                 std::vector<PathVertex>& vertices);

}  // namespace alhazen
