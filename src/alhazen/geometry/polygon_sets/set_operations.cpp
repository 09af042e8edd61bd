#include "alhazen/geometry/polygon_sets/set_operations.h"

#include "alhazen/geometry/polygon_sets/edge_sweep.h"
#include "alhazen/geometry/polygon_sets/region_tracer.h"

namespace alhazen {

namespace {

/// The memory of one thread's operations.
struct SetWorkspace {
    EdgeSweep sweep;
    RegionTracer tracer;
};

SetWorkspace& set_workspace() {
    thread_local SetWorkspace workspace;
    return workspace;
}

// [state] 0 outside both, 1 in the first, 2 in the second, 3 in both.
constexpr RegionTracer::States kBoth{false, false, false, true};
constexpr RegionTracer::States kFirstOnly{false, true, false, false};
constexpr RegionTracer::States kAny{false, true, true, true};
constexpr RegionTracer::States kOne{false, true, true, false};

EdgeSweep& sweep_both(const PolygonSet& a, const PolygonSet& b) {
    SetWorkspace& w = set_workspace();
    w.sweep.clear();
    for (std::size_t i = 0; i < a.loop_count(); ++i) {
        w.sweep.add_loop(a.loop(i), kInFirst);
    }
    for (std::size_t i = 0; i < b.loop_count(); ++i) {
        w.sweep.add_loop(b.loop(i), kInSecond);
    }
    w.sweep.run();
    return w.sweep;
}

RegionTracer& arrange(const PolygonSet& a, const PolygonSet& b) {
    const Arrangement& arrangement = sweep_both(a, b).result();
    RegionTracer& tracer = set_workspace().tracer;
    tracer.prepare(arrangement);
    return tracer;
}

/// True if the sets can have at most a boundary in common, by their bounds.
bool apart(const PolygonSet& a, const PolygonSet& b) {
    return a.empty() || b.empty() || !a.bounds().meets(b.bounds());
}

}  // namespace

const Arrangement& exact_arrangement(const PolygonSet& first, const PolygonSet& second) {
    return sweep_both(first, second).result();
}

PolygonSet intersection(const PolygonSet& a, const PolygonSet& b) {
    PolygonSet result;
    if (!apart(a, b)) {
        arrange(a, b).trace(kBoth, result);
    }
    return result;
}

PolygonSet difference(const PolygonSet& a, const PolygonSet& b) {
    if (apart(a, b)) {
        return a;
    }
    PolygonSet result;
    arrange(a, b).trace(kFirstOnly, result);
    return result;
}

PolygonSet union_of(const PolygonSet& a, const PolygonSet& b) {
    if (a.empty()) {
        return b;
    }
    if (b.empty()) {
        return a;
    }
    PolygonSet result;
    arrange(a, b).trace(kAny, result);
    return result;
}

PolygonSet symmetric_difference(const PolygonSet& a, const PolygonSet& b) {
    if (a.empty()) {
        return b;
    }
    if (b.empty()) {
        return a;
    }
    PolygonSet result;
    arrange(a, b).trace(kOne, result);
    return result;
}

PolygonCut cut(const PolygonSet& a, const PolygonSet& b) {
    PolygonCut parts;
    cut(a, b, parts);
    return parts;
}

void cut(const PolygonSet& a, const PolygonSet& b, PolygonCut& parts) {
    if (apart(a, b)) {
        parts.inside.clear();
        parts.outside = a;
        return;
    }
    RegionTracer& tracer = arrange(a, b);
    tracer.trace(kBoth, parts.inside);
    tracer.trace(kFirstOnly, parts.outside);
}

}  // namespace alhazen
