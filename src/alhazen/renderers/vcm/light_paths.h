#pragma once
/// Light paths of a pass, whose vertices are kept to be merged with those of eye paths.
///
/// Source: Georgiev, Krivanek, Davidovic and Slusallek, "Light Transport Simulation with Vertex
/// Connection and Merging", SIGGRAPH Asia 2012, section 5.
/// Differs: connections have light paths of their own, one for each sample, as in `bidirectional`;
/// a pass may have any number of paths to merge with. Vertices that a lamp lights straight, and
/// those in volumes, are not kept.
/// Conventions: paths are numbered through all passes. What a path does depends on the scene, the
/// seed and its number alone. Where a surface is there in part, what its vertices carry is divided
/// by the coverage, for both paths stop there by chance.

#include <cstdint>
#include <memory>
#include <vector>

#include "alhazen/renderers/core/sample_loop.h"
#include "alhazen/renderers/light_transport/light_starts.h"
#include "alhazen/renderers/light_transport/path_settings.h"
#include "alhazen/renderers/light_transport/random_walk.h"
#include "alhazen/renderers/photons/photon.h"
#include "alhazen/renderers/photons/photon_grid.h"
#include "alhazen/renderers/vcm/merge_sums.h"

namespace alhazen {

/// A surface that light came to, at least by way of another one.
struct LightVertex {
    Photon photon;  ///< its power: over the number of paths
    SideSums sums;
    double facing = 0;         ///< makes a density by solid angle from here one by area at the
                               ///< vertex before
    std::uint32_t number = 0;  ///< surfaces of its path up to it and with it

    [[nodiscard]] Vec3 point() const { return photon.point(); }
};
using LightVertexGrid = PointGrid<LightVertex>;

/// What paths have in common.
struct LightPathShot {
    std::uint64_t count = 0;  ///< of the pass
    std::uint64_t first = 0;  ///< number of its first path
    PathSettings settings;
    double merging = 0;                          ///< WholePath::merging
    const Wavelengths* waves = &kColorChannels;  ///< of all paths
    ShutterPart shutter{};                       ///< in which all are
};

/// The numbers of light paths: of one sampler for a whole picture.
class LightPathNumbers {
  public:
    LightPathNumbers(const RenderJob& job, std::uint64_t seed);
    /// With `RenderJob::round` for PathChance.
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

    /// Appends the vertices of path `number` of 0 .. count - 1. False: its light gave it no power.
    bool shoot(std::uint64_t number, std::vector<LightVertex>& kept);

  private:
    /// Of the first vertex of `path_`; `facing` as of LightVertex.
    [[nodiscard]] SideSums begin(const LightRay& light, double& facing) const;
    void keep(const PathVertex& v, const SideSums& sums, double facing, std::size_t number,
              std::vector<LightVertex>& kept) const;

    const RenderJob& job_;
    const Illumination& lights_;
    LightPathShot shot_;
    PathChance chance_;
    LightStarts starts_;
    RandomWalk walk_;
    std::vector<PathVertex> path_;
};

}  // namespace alhazen
