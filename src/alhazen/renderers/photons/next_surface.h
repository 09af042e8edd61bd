#pragma once
/// Advances a path from surface to surface, for paths that are traced one by one.
///
/// Conventions: a partly covering surface is hit with the probability of its coverage; those of
/// coverage 0 are passed. Its openings lead into the volume that it bounds. Media attenuate the
/// light; in a scattering medium the path may end before the next surface.

#include <cstdint>

#include "alhazen/illumination/illumination.h"
#include "alhazen/renderers/core/coincident_surfaces.h"
#include "alhazen/renderers/core/ray_counters.h"
#include "alhazen/renderers/light_transport/met_faces.h"
#include "alhazen/renderers/light_transport/passed_surfaces.h"
#include "alhazen/renderers/light_transport/scatter_point.h"
#include "alhazen/renderers/light_transport/scattering_media.h"

namespace alhazen {

/// Random numbers of one path, by its index and the index of the draw.
struct PathNumbers {
    std::uint64_t seed = 0, path = 0, part = 0;

    [[nodiscard]] double at(std::uint64_t dimension) const;
};

struct PathEnd {
    Ray ray;
    RayKind kind = RayKind::Eye;
    bool as_connection = false;  ///< see WalkStart
    bool chooses = false;        ///< segments may end at surfaces that do not block them
    bool passed = false;         ///< the last one did
    float time = 0;
    RayCone cone;
    MediumStack media;
    const Wavelengths* waves = &kColorChannels;
    Spectrum throughput{1, 1, 1, 1};
    double travelled = 0;       ///< since the last scattering
    std::uint32_t met = 0;      ///< number of surfaces met
    std::uint32_t stretch = 0;  ///< number of segments in scattering media
    std::uint32_t chosen = 0;   ///< number of choices of ends

    [[nodiscard]] RayMask mask() const {
        return as_connection && !passed ? kConnectingRays : mask_of(kind);
    }
};

/// The next event of a path.
enum class PathMeets : std::uint8_t { Nothing, Surface, Volume };

/// A scattering event inside a volume.
struct VolumePoint {
    Vec3 point;
    Vec3 along;  ///< unit direction of the path
    Medium medium;
    double anisotropy = 0;
    Spectrum arrived;  ///< the throughput there, without the scattering albedo
};

class NextSurface {
  public:
    NextSurface(const Scene& scene, RayCounters& counters, TraversalStats* stats)
        : scene_(scene),
          counters_(counters),
          stats_(stats),
          media_(scene),
          faces_(scene),
          here_(scene),
          surfaces_(scene, stats) {}

    /// Advances to the next event: Nothing if the path leaves the scene.
    [[nodiscard]] PathMeets find(PathEnd& path, const PathNumbers& numbers);
    /// The surface found; valid until the next `find`.
    [[nodiscard]] const ShadingPoint& point() const { return point_; }
    /// The event found in a volume.
    [[nodiscard]] const VolumePoint& volume() const { return volume_; }
    [[nodiscard]] const ScatteringMedia& media() const { return media_; }
    [[nodiscard]] const Hit& hit() const { return hit_; }
    /// The rays that see the surface found.
    [[nodiscard]] RayMask seen_by() const { return surfaces_.seen_by(hit_); }
    /// The faces that coincide with the surface found.
    [[nodiscard]] const OtherFaces& others() const { return faces_.others(); }
    /// MetFaces::sheet.
    [[nodiscard]] const ScatterPoint* sheet() const { return faces_.sheet(); }
    /// Continues after a surface at the point `at`.
    static void go_on(PathEnd& path, const ShapeSurface& at, const ScatterPoint& scatter,
                      const Scattered& drawn);
    /// Continues after an event in a volume; `u` samples the direction.
    void go_on_in_volume(PathEnd& path, const Vec2& u) const;

  private:
    /// True if the path stops at the surface that was hit, or at one behind it at the same place,
    /// which is then the surface hit; else `beyond_` is the ray behind them.
    [[nodiscard]] bool stops_here(PathEnd& path, const Arrival& arrival,
                                  const PathNumbers& numbers);
    /// Attenuates over the length; true if the path is scattered before its end.
    [[nodiscard]] bool cross_medium(PathEnd& path, double length, const PathNumbers& numbers);

    const Scene& scene_;
    RayCounters& counters_;
    TraversalStats* stats_;
    ScatteringMedia media_;
    ShadingPoint point_;
    MetFaces faces_;  ///< at the point
    CoincidentSurfaces here_;
    Ray beyond_;
    PassedSurfaces surfaces_;
    ScatterPoint opening_;  ///< a surface passed where it does not cover
    VolumePoint volume_;
    Hit hit_;
};

}  // namespace alhazen
