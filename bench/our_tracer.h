#pragma once
/// wide_bvh over a benchmark scene; traces rays one by one and in batches.

#include <array>
#include <memory>
#include <vector>

#include "alhazen/accel/wide_bvh/build/build_options.h"
#include "alhazen/primitives/aggregate.h"
#include "kernel_rays.h"

namespace alhazen::bench {

/// Rays per batch call, as many as in a renderer's tile.
inline constexpr std::size_t kBatch = 1024;

/// Builds the scene with quality High, as Embree's trees are built here.
[[nodiscard]] std::shared_ptr<const Aggregate> build_ours(const KernelScene& scene,
                                                          const BuildOptions& options = {
                                                              BuildQuality::High});
/// Builds the scene visible only to rays of `kSeeing`, with one small invisible triangle in a
/// corner: every test checks masks, and the hits are the same.
[[nodiscard]] std::shared_ptr<const Aggregate> build_masked(const KernelScene& scene,
                                                            const BuildOptions& options);
inline constexpr RayMask kSeeing = 1;

/// Traces all rays of the set by `closest` or `occluded`; returns the number of hits.
[[nodiscard]] std::size_t trace_single(const Aggregate& aggregate, const RaySet& set,
                                       RayMask mask = kAllRays);
/// Traces by `closest_batch` or `occluded_batch`, kBatch rays per call; returns the number of hits.
[[nodiscard]] std::size_t trace_batches(const Aggregate& aggregate, const RaySet& set,
                                        RayMask mask = kAllRays);

/// The rays of a set in columns of floats, as the library takes them: one origin and one range
/// where all rays have the same.
class ColumnsOfRays {
  public:
    explicit ColumnsOfRays(const RaySet& set);
    [[nodiscard]] const RayColumns& rays() const { return rays_; }

  private:
    std::array<std::vector<float>, 8> numbers_;  ///< origin, direction, t_min, t_max
    RayColumns rays_;
};
/// Traces by `closest_columns` or `occluded_columns`, kBatch rays per call, with t, u, v and ids of
/// closest hits; returns the number of hits. `rays` are those of the set.
[[nodiscard]] std::size_t trace_columns(const Aggregate& aggregate, const RaySet& set,
                                        const RayColumns& rays);

/// Mean counted work per ray of the set.
struct WorkPerRay {
    double node_visits = 0, primitive_tests = 0, primitive_hits = 0;
};
[[nodiscard]] WorkPerRay count_work(const Aggregate& aggregate, const RaySet& set);

}  // namespace alhazen::bench
