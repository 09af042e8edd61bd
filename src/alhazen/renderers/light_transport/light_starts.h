#pragma once
/// The first rays of light paths: from emitters, or from in front of the scene for far lights.
///
/// Conventions: rays of the environment and of directional lights come from a disc in front of all
/// bounded geometry (Illumination::emit). In scenes with unbounded geometry they begin before their
/// first crossing of it, so that it reflects, refracts or blocks them. Light from infinity through
/// an unbounded volume that absorbs or scatters is black.
/// Threads: const functions may be called from many.

#include <vector>

#include "alhazen/illumination/illumination.h"
#include "alhazen/renderers/light_transport/random_walk.h"
#include "alhazen/renderers/light_transport/scattering_media.h"
#include "alhazen/renderers/volumes/media_finder.h"

namespace alhazen {

class LightStarts {
  public:
    explicit LightStarts(const Scene& scene);

    /// The start of the walk of a ray of light. Its throughput is black if no light arrives.
    [[nodiscard]] WalkStart of(const LightRay& light, float time, const Wavelengths& waves) const;

  private:
    /// Moves the origin in front of all crossings. False if an opaque surface is too far away for
    /// that: no light passes.
    [[nodiscard]] bool begin_before_all(Ray& ray, float time) const;
    /// Moves the start of a far light in front of all unbounded geometry; sets the volumes there.
    void begin_from_infinity(WalkStart& start) const;

    const Scene& scene_;
    MediaFinder media_;
    ScatteringMedia scattering_;
    bool is_endless_;
    double radius_;  ///< of a sphere around all bounded geometry
};

/// Applies the falloff of a point light over the first segment to the vertices of its path.
void set_falloff(const Illumination& lights, const LightRay& light, const Wavelengths& waves,
                 std::vector<PathVertex>& vertices);

}  // namespace alhazen
