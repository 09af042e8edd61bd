#pragma once
/// wide_bvh over a benchmark scene; traces rays one by one and in batches.

#include <memory>

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

/// Mean counted work per ray of the set.
struct WorkPerRay {
    double node_visits = 0, primitive_tests = 0, primitive_hits = 0;
};
[[nodiscard]] WorkPerRay count_work(const Aggregate& aggregate, const RaySet& set);

}  // namespace alhazen::bench
