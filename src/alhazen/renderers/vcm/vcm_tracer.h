#pragma once
/// Pairs of subpaths whose eye vertices are also merged with vertices of further light paths.

#include <atomic>
#include <cstdint>

#include "alhazen/renderers/bidirectional/bidirectional_tracer.h"
#include "alhazen/renderers/vcm/light_paths.h"

namespace alhazen {

/// The light paths of a pass.
struct MergePass {
    const LightVertexGrid& grid;
    double merging;                        ///< WholePath::merging
    const Wavelengths* waves;              ///< common to all paths; null: each path has its own
    std::atomic<std::uint64_t> merged{0};  ///< merged pairs of vertices
};

class VcmTracer final : public BidirectionalTracer {
  public:
    VcmTracer(const RenderJob& job, std::size_t at_once, RayCounters& counters,
              const Illumination& lights, const PathSettings& settings, LensLight* lens_light,
              MergePass* pass);

  private:
    void merge(Spectrum& sum) override;
    /// Radiance scattered at eye vertex b - 1 by merging.
    [[nodiscard]] Spectrum merged_at(std::size_t b, const SideSums& eye,
                                     std::uint64_t& merged) const;

    MergePass& pass_;
};

}  // namespace alhazen
