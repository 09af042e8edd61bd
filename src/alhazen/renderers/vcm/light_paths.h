#pragma once
/// Light paths of a pass, whose vertices are stored for merging with those of eye paths.
///
/// Source: Georgiev, Krivanek, Davidovic and Slusallek, "Light Transport Simulation with Vertex
/// Connection and Merging", SIGGRAPH Asia 2012, section 5.
/// Differs: connections use separate light paths, one for each sample, as in `bidirectional`; a
/// pass may have any number of paths for merging. Vertices of direct light, and those in volumes,
/// are not stored.
/// Conventions: paths are numbered through all passes. A path depends only on the scene, the seed
/// and its number. At a partly covering surface the vertices' light is divided by the coverage,
/// since both paths stop there at random.

#include <cstdint>
#include <memory>
#include <vector>

#include "alhazen/renderers/core/sample_loop.h"
#include "alhazen/renderers/light_transport/light_starts.h"
#include "alhazen/renderers/light_transport/path_settings.h"
#include "alhazen/renderers/light_transport/power_heuristic.h"
#include "alhazen/renderers/light_transport/random_walk.h"
#include "alhazen/renderers/photons/photon.h"
#include "alhazen/renderers/photons/photon_grid.h"
#include "alhazen/renderers/vcm/merge_sums.h"

namespace alhazen {

/// A surface that light has reached by way of at least one other surface.
struct LightVertex {
    Photon photon;  ///< its power: over the number of paths
    SideSums sums;
    double facing = 0;         ///< factor from a density by solid angle to one by area at the
                               ///< previous vertex
    std::uint32_t number = 0;  ///< index of its surface along the path, from 1

    [[nodiscard]] Vec3 point() const { return photon.point(); }
};
using LightVertexGrid = PointGrid<LightVertex>;

/// Common parameters of the paths.
struct LightPathShot {
    std::uint64_t count = 0;  ///< paths of the pass
    std::uint64_t first = 0;  ///< number of its first path
    PathSettings settings;
    double merging = 0;                          ///< WholePath::merging
    const Wavelengths* waves = &kColorChannels;  ///< of all paths
    ShutterPart shutter{};                       ///< interval of their times
};

/// Random numbers of light paths: of one sampler for a whole picture.
class LightPathNumbers {
  public:
    LightPathNumbers(const RenderJob& job, std::uint64_t seed);
    /// The job, with a `RenderJob::round` for PathRandomness.
    [[nodiscard]] const RenderJob& job() const { return job_; }
    [[nodiscard]] static SampleId id(std::uint64_t number);

  private:
    std::unique_ptr<Sampler> sampler_;
    FilterKernel filter_;
    std::unique_ptr<SampleRound> round_;
    RenderJob job_;
};

class LightPathWalk {
  public:
    LightPathWalk(const LightPathNumbers& numbers, const Illumination& lights,
                  const LightPathShot& shot, RayCounters& counters, TraversalStats* stats);

    /// Traces path `number` of 0 .. count - 1 and appends its vertices. False if its light gave it
    /// no power.
    bool shoot(std::uint64_t number, std::vector<LightVertex>& kept);

  private:
    /// Sums for the first vertex of `path_`; `facing` as in LightVertex.
    [[nodiscard]] SideSums begin(const LightRay& light, double& facing) const;
    void keep(const PathVertex& v, const SideSums& sums, double facing, std::size_t number,
              std::vector<LightVertex>& kept) const;

    const RenderJob& job_;
    const Illumination& lights_;
    DirectLightWeights weights_;
    LightPathShot shot_;
    PathRandomness random_;
    LightStarts starts_;
    RandomWalk walk_;
    std::vector<PathVertex> path_;
};

}  // namespace alhazen
