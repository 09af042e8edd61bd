#include "alhazen/aggregates/wide_bvh/leaves/build_references.h"

#include <algorithm>

#include "alhazen/aggregates/wide_bvh/leaves/leaf_bounds.h"
#include "alhazen/aggregates/wide_bvh/leaves/triangle_references.h"
#include "alhazen/base/interruption.h"
#include "alhazen/parallel/parallel.h"

namespace alhazen {
namespace {

constexpr std::size_t kReferencesAtOnce = 16384;

BuildReference reference_to(std::uint32_t id, const Box3& box, const PrimitiveTable& table,
                            const LocalFrame& frame) {
    return {frame.local(box), id, static_cast<std::uint32_t>(leaf_type(table, PrimitiveId{id}))};
}

}  // namespace

void make_references(const PrimitiveTable& table, const BoundedPrimitives& bounded,
                     const LocalFrame& frame, std::span<BuildReference> references) {
    // If all are bounded, runs of triangles are known by their ids.
    const bool all = bounded.size() == table.size();
    const std::uint32_t first = all ? table.first(kTriangleKind) : 0;
    const std::uint32_t last = all ? table.first(kInstanceKind) : 0;
    const TriangleReferences to_triangle(frame);
    parallel_for(bounded.size(), kReferencesAtOnce, [&](std::size_t chunk, std::size_t chunk_end) {
        interruption_point();
        const auto begin = static_cast<std::uint32_t>(chunk);
        const auto end = static_cast<std::uint32_t>(chunk_end);
        const auto others = [&](std::uint32_t from, std::uint32_t to) {
            for (std::uint32_t i = from; i < to; ++i) {
                references[i] = reference_to(bounded.id(i), bounded.box(i), table, frame);
            }
        };
        others(begin, std::min(end, first));
        for_triangles(table, std::max(begin, first), std::min(end, last),
                      [&](std::uint32_t id, const Vec3& a, const Vec3& b, const Vec3& c) {
                          to_triangle(TriangleBounds(a, b, c), id, references.data()[id]);
                      });
        others(std::max(begin, last), end);
    });
}

}  // namespace alhazen
