#pragma once
/// Compares Embree and wide_bvh on the same rays and resolves their disagreements.

#include <string>
#include <vector>

#include "disagreements.h"
#include "embree/embree_scene.h"

namespace alhazen::bench {

struct PeerScene {
    std::string group;   ///< "embree robust", "embree fast"
    std::string suffix;  ///< suffix of its tracers' names; empty with one scene per group
    const EmbreeScene* scene;
};

/// One ray set traced in one way by Embree.
struct CheckResult {
    std::string scene, rays, peer;
    std::size_t count = 0;
    std::size_t disagreements = 0;
    std::size_t ours_wrong = 0, peer_wrong = 0;
    std::size_t both_right = 0;     ///< the ray passes through an edge or is tangent
    std::size_t batch_differs = 0;  ///< rays whose batch hit differs from the single one in any bit
    /// Rays judged without a disagreement, and planted wrong answers that the judge did not detect.
    std::size_t samples = 0, planted_unseen = 0;
    std::vector<std::string> our_faults;  ///< the first few, for inspection
    std::vector<std::string> unseen;      ///< missed planted errors
};

/// Traces the set by `closest` or `occluded`, by the batch queries, and by each peer with packets
/// of 1 and 16.
[[nodiscard]] std::vector<CheckResult> check(const KernelScene& scene, const Aggregate& aggregate,
                                             const RaySet& set,
                                             const std::vector<PeerScene>& peers);

[[nodiscard]] std::string as_markdown(const std::vector<CheckResult>& results);

}  // namespace alhazen::bench
