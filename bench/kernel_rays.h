#pragma once
/// The kinds of ray sets of a renderer, made once and traced by every kernel.

#include <string>
#include <vector>

#include "alhazen/primitives/aggregate.h"
#include "kernel_scenes.h"

namespace alhazen::bench {

struct RaySet {
    std::string name;
    bool any_hit = false;
    bool coherent = false;  ///< neighbours in the list are nearly parallel
    std::vector<Ray> rays;
};

/// Ray sets. eye: side x side rays in 8x8 tiles; shadow: from their hits to a point light; bounce:
/// cosine-distributed from their hits; ambient: as bounce, for any hit; shuffled: bounce in random
/// order; lines: random lines through the bounds. All coordinates are rounded to float, so that a
/// kernel in float traces the same rays.
[[nodiscard]] std::vector<RaySet> ray_sets(const KernelScene& scene, const Aggregate& aggregate,
                                           int side);

}  // namespace alhazen::bench
