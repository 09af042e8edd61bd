#pragma once
/// wide_bvh over a benchmark scene; traces rays one by one and in batches.

#include <array>
#include <cstddef>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "alhazen/accel/wide_bvh/build/build_options.h"
#include "alhazen/primitives/aggregate.h"
#include "kernel_rays.h"
#include "measure.h"

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
/// Traces the rays of a set in the ways the library has. The memory for the results is there before
/// a clock starts, as that of Embree's packets is. Each way returns the number of hits if it
/// `counts`, else 0.
class OurTracer {
  public:
    OurTracer(const Aggregate& aggregate, const RaySet& set, RayMask mask = kAllRays);

    /// By `closest` or `occluded`.
    std::size_t single(bool counts);
    /// By `closest_batch` or `occluded_batch`, kBatch rays per call.
    std::size_t batches(bool counts);
    /// By `closest_columns` or `occluded_columns`, kBatch rays per call, with t, u, v and ids of
    /// closest hits. `rays` are those of the set.
    std::size_t columns(const RayColumns& rays, bool counts);

  private:
    const Aggregate& aggregate_;
    const RaySet& set_;
    RayQuery query_;
    std::vector<Hit> hits_;
    std::vector<double> t_, u_, v_;
    std::vector<PrimitiveId> ids_;
    std::unique_ptr<bool[]> occluded_;
};
/// `trace(counts)` as above: hits are counted outside the clock, as Embree's are.
template <class Trace>
[[nodiscard]] Contender our_contender(std::string group, std::string name, Trace trace) {
    return {std::move(group),
            std::move(name),
            {},
            [trace] { (void)trace(false); },
            [trace] { return trace(true); }};
}

/// Mean counted work per ray of the set.
struct WorkPerRay {
    double node_visits = 0, primitive_tests = 0, primitive_hits = 0;
};
[[nodiscard]] WorkPerRay count_work(const Aggregate& aggregate, const RaySet& set);

}  // namespace alhazen::bench
