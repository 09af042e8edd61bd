#include "alhazen/primitives/bounded_primitives.h"

#include <algorithm>

#include "alhazen/parallel/parallel.h"
#include "alhazen/primitives/triangle_run.h"

namespace alhazen {
namespace {

bool within_reach(const Box3& box) {
    const double reach = BoundedPrimitives::kReach;
    // False for NaN.
    return max_component(abs(box.lo)) <= reach && max_component(abs(box.hi)) <= reach &&
           is_finite(box.lo) && is_finite(box.hi);
}

/// The box of a range of primitives, and whether all of them are bounded.
struct Share {
    Box3 box;
    bool bounded = true;

    void include(const PrimitiveTable& table, std::uint32_t begin, std::uint32_t end) {
        const std::uint32_t first = table.first(kTriangleKind), last = table.first(kInstanceKind);
        include_others(table, begin, std::min(end, first));
        include_triangles(table, std::max(begin, first), std::min(end, last));
        include_others(table, std::max(begin, last), end);
    }

  private:
    void include_others(const PrimitiveTable& table, std::uint32_t begin, std::uint32_t end) {
        for (std::uint32_t i = begin; i < end; ++i) {
            const Box3 one = table.box(i);
            box.include(one);
            bounded = bounded && one != Box3{} && within_reach(one);
        }
    }
    void include_triangles(const PrimitiveTable& table, std::uint32_t begin, std::uint32_t end) {
        if (begin >= end) return;
        TriangleBounds all;
        bool complete = true;
        const IncludeRun include = include_run();
        for_mesh_parts(
            table, begin, end,
            [&](std::uint32_t, const PlacedMesh& placed, std::uint32_t first, std::uint32_t last) {
                const TriangleMesh& mesh = *placed.mesh;
                const TriangleRun run{mesh.positions.data(), mesh.triangles.data() + first,
                                      last - first};
                complete = include(run, all) && complete;
            });
        // `padded` has another margin for infinite boxes than the lanes.
        if (!within_reach(all.box())) return include_others(table, begin, end);
        box.include(all.box());
        bounded = bounded && complete;
    }
};

}  // namespace

BoundedPrimitives::BoundedPrimitives(const PrimitiveTable& table) : table_(table) {
    // Usually all primitives are bounded: then no list of ids is made.
    constexpr std::size_t kGrain = 4096;
    std::vector<Share> parts((table.size() + kGrain - 1) / kGrain);
    parallel_for(table.size(), kGrain, [&](std::size_t begin, std::size_t end) {
        parts[begin / kGrain].include(table, static_cast<std::uint32_t>(begin),
                                      static_cast<std::uint32_t>(end));
    });
    identity_ = true;
    for (const Share& part : parts) {
        all_.include(part.box);
        identity_ = identity_ && part.bounded;
    }
    if (identity_) return;
    for (std::size_t i = 0; i < table.size(); ++i) {
        const Box3 box = table.box(i);
        // An empty box (an instance of nothing) cannot be hit.
        if (box == Box3{}) continue;
        if (within_reach(box)) {
            bounded_.push_back(static_cast<std::uint32_t>(i));
        } else {
            unbounded_.push_back(PrimitiveId{static_cast<std::uint32_t>(i)});
        }
    }
}

}  // namespace alhazen
