#pragma once
/// The end of a path on its way from surface to surface, for paths that are followed one by one.
///
/// Conventions: surfaces that are there in part are met by chance, by their coverage; those of
/// coverage 0 are passed. Media take their share of the light.

#include <cstdint>

#include "alhazen/illumination/illumination.h"
#include "alhazen/renderers/core/ray_counters.h"
#include "alhazen/renderers/light_transport/scatter_point.h"

namespace alhazen {

/// Random numbers of one path: by its name and the number of what is drawn.
struct PathNumbers {
    std::uint64_t seed = 0, path = 0, part = 0;

    [[nodiscard]] double at(std::uint64_t dimension) const;
};

struct PathEnd {
    Ray ray;
    RayKind kind = RayKind::Eye;
    float time = 0;
    RayCone cone;
    MediumStack media;
    const Wavelengths* waves = &kColorChannels;
    Spectrum throughput{1, 1, 1, 1};
    double travelled = 0;   ///< since the last scattering
    std::uint32_t met = 0;  ///< surfaces on its way
};

class NextSurface {
  public:
    NextSurface(const Scene& scene, RayCounters& counters, TraversalStats* stats)
        : scene_(scene), counters_(counters), stats_(stats) {}

    /// Goes on to the next surface on which the path stops; false where it leaves the scene.
    [[nodiscard]] bool find(PathEnd& path, const PathNumbers& numbers);
    /// What was found; valid until the next `find`.
    [[nodiscard]] const ShadingPoint& point() const { return point_; }
    [[nodiscard]] const Hit& hit() const { return hit_; }
    /// Continues from what was found. The point of the surface is `at`.
    static void go_on(PathEnd& path, const ShapeSurface& at, const ScatterPoint& scatter,
                      const Scattered& drawn);

  private:
    const Scene& scene_;
    RayCounters& counters_;
    TraversalStats* stats_;
    ShadingPoint point_;
    Hit hit_;
};

}  // namespace alhazen
