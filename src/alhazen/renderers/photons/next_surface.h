#pragma once
/// The end of a path on its way from surface to surface, for paths that are followed one by one.
///
/// Conventions: surfaces that are there in part are met by chance, by their coverage; those of
/// coverage 0 are passed. Openings lead into the volumes that the surfaces bound. Media take their
/// share of the light; where one scatters it the path may
/// end before the next surface.

#include <cstdint>

#include "alhazen/illumination/illumination.h"
#include "alhazen/renderers/core/ray_counters.h"
#include "alhazen/renderers/light_transport/scatter_point.h"
#include "alhazen/renderers/light_transport/scattering_media.h"

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
    double travelled = 0;       ///< since the last scattering
    std::uint32_t met = 0;      ///< surfaces on its way
    std::uint32_t stretch = 0;  ///< ways through media that scatter
};

/// What a path meets next.
enum class PathMeets : std::uint8_t { Nothing, Surface, Volume };

/// Where a path is scattered inside a volume.
struct VolumePoint {
    Vec3 point;
    Vec3 along;  ///< unit, in which the path goes
    Medium medium;
    double anisotropy = 0;
    Spectrum arrived;  ///< the throughput there, without the share that is scattered
};

class NextSurface {
  public:
    NextSurface(const Scene& scene, RayCounters& counters, TraversalStats* stats)
        : scene_(scene), counters_(counters), stats_(stats), media_(scene), faces_(scene) {}

    /// Goes on to where the path stops next: Nothing where it leaves the scene.
    [[nodiscard]] PathMeets find(PathEnd& path, const PathNumbers& numbers);
    /// The surface that was found; valid until the next `find`.
    [[nodiscard]] const ShadingPoint& point() const { return point_; }
    /// The place in a volume that was found.
    [[nodiscard]] const VolumePoint& volume() const { return volume_; }
    [[nodiscard]] const ScatteringMedia& media() const { return media_; }
    [[nodiscard]] const Hit& hit() const { return hit_; }
    /// Those that are crossed with the surface that was found.
    [[nodiscard]] const OtherFaces& others() const { return faces_.others(); }
    /// Continues from what was found. The point of the surface is `at`.
    static void go_on(PathEnd& path, const ShapeSurface& at, const ScatterPoint& scatter,
                      const Scattered& drawn);
    /// Continues from the place in a volume: `u` draws the direction.
    void go_on_in_volume(PathEnd& path, const Vec2& u) const;

  private:
    /// The way of that length takes its share; true: the path is scattered before its end.
    [[nodiscard]] bool cross_medium(PathEnd& path, double length, const PathNumbers& numbers);

    const Scene& scene_;
    RayCounters& counters_;
    TraversalStats* stats_;
    ScatteringMedia media_;
    ShadingPoint point_;
    CoincidentFaces faces_;  ///< at the point
    ScatterPoint opening_;   ///< a surface that is passed where it does not cover
    VolumePoint volume_;
    Hit hit_;
};

}  // namespace alhazen
