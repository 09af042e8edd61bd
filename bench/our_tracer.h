#pragma once
/// wide_bvh over a scene of the benchmarks, and its rays one by one and in batches.

#include <memory>

#include "alhazen/accel/wide_bvh/build/build_options.h"
#include "alhazen/primitives/aggregate.h"
#include "kernel_rays.h"

namespace alhazen::bench {

/// Rays of one call of the batch: as many as a renderer's tile has.
inline constexpr std::size_t kBatch = 1024;

/// With the quality High, as Embree's trees are made here.
[[nodiscard]] std::shared_ptr<const Aggregate> build_ours(const KernelScene& scene,
                                                          const BuildOptions& options = {
                                                              BuildQuality::High});
/// The same seen by rays of `kSeeing` only, and besides one small triangle in a corner that they do
/// not see: every test asks for masks, and the hits are the same.
[[nodiscard]] std::shared_ptr<const Aggregate> build_masked(const KernelScene& scene,
                                                            const BuildOptions& options);
inline constexpr RayMask kSeeing = 1;

/// Traces all rays of the set, `closest` or `occluded`; the number that hit.
[[nodiscard]] std::size_t trace_single(const Aggregate& aggregate, const RaySet& set,
                                       RayMask mask = kAllRays);
/// The same by `closest_batch` or `occluded_batch`, kBatch rays a call.
[[nodiscard]] std::size_t trace_batches(const Aggregate& aggregate, const RaySet& set,
                                        RayMask mask = kAllRays);

/// What a ray of the set costs on average, counted.
struct WorkPerRay {
    double node_visits = 0, primitive_tests = 0, primitive_hits = 0;
};
[[nodiscard]] WorkPerRay count_work(const Aggregate& aggregate, const RaySet& set);

}  // namespace alhazen::bench
