#include "alhazen/geometry/polygon_sets/mending.h"

#include <algorithm>
#include <cstdlib>

#include "alhazen/base/error.h"
#include "alhazen/geometry/polygon_sets/edge_sweep.h"
#include "alhazen/geometry/polygon_sets/region_tracer.h"

namespace alhazen {

namespace {

void refuse_far_points(const LatticeLoop& loop) {
    for (const LatticePoint p : loop) {
        if (p.x < -kLatticeLimit || p.x > kLatticeLimit || p.y < -kLatticeLimit ||
            p.y > kLatticeLimit) {
            throw Error(ErrorKind::Scene, "polygon: vertex (" + std::to_string(p.x) + ", " +
                                              std::to_string(p.y) +
                                              ") is outside of [-2^24, 2^24]");
        }
    }
}

void count_flaws(const LatticeLoop& loop, Mending& mending) {
    for (std::size_t i = 0; i < loop.size(); ++i) {
        mending.repeated_points += loop[i] == loop[(i + 1) % loop.size()] ? 1U : 0U;
    }
    bool flat = true;
    for (std::size_t i = 2; i < loop.size() && flat; ++i) {
        flat = turn(loop[0], loop[1], loop[i]) == 0 && turn(loop[0], loop[i - 1], loop[i]) == 0;
    }
    mending.flat_loops += flat ? 1U : 0U;
}

}  // namespace

std::string to_string(const Mending& mending) {
    std::string text;
    const auto add = [&text](std::size_t count, const char* one, const char* many) {
        if (count > 0) {
            text += (text.empty() ? "" : ", ") + std::to_string(count) + " " +
                    (count == 1 ? one : many);
        }
    };
    add(mending.crossings, "crossing", "crossings");
    add(mending.overlaps, "piece of edges on each other", "pieces of edges on each other");
    add(mending.flat_loops, "loop without area", "loops without area");
    add(mending.repeated_points, "repeated point", "repeated points");
    add(mending.touches, "point where outlines touch", "points where outlines touch");
    return text;
}

PolygonSet polygon_set(std::span<const LatticeLoop> loops, Mending* mending) {
    thread_local EdgeSweep sweep;
    thread_local RegionTracer tracer;
    Mending found;
    sweep.clear();
    for (const LatticeLoop& loop : loops) {
        refuse_far_points(loop);
        if (mending != nullptr) {
            count_flaws(loop, found);
        }
        sweep.add_loop(loop, kInFirst);
    }
    sweep.run();
    tracer.prepare(sweep.result());
    PolygonSet result;
    tracer.trace({false, true, false, false}, result);
    if (mending != nullptr) {
        found.crossings = sweep.result().crossings;
        found.overlaps = sweep.result().overlaps;
        found.touches = tracer.touches();
        *mending = found;
    }
    return result;
}

PolygonSet polygon_set(const LatticeLoop& loop, Mending* mending) {
    return polygon_set(std::span(&loop, 1), mending);
}

}  // namespace alhazen
