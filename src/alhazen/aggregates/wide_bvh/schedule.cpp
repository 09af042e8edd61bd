#include "alhazen/aggregates/wide_bvh/schedule.h"

#include <algorithm>

#include "alhazen/primitives/primitive_columns.h"
#include "alhazen/primitives/primitive_lanes.h"
#include "alhazen/shapes/core/first_hits.h"

namespace alhazen {
namespace {

/// More shapes than these cost more in lanes than a tree whose boxes are missed.
constexpr std::size_t kMaxTreelessShapes = 4;
/// Packets win in trees that lie near the core; in larger ones they give up where primitives are
/// finer than the rays lie apart.
constexpr std::size_t kMaxPacketTreeBytes = std::size_t{8} << 20;
/// At most one primitive in so many may be met ray by ray where packets are used.
constexpr std::size_t kMinPrimitivesPerSingle = 64;
/// In trees that lie in the caches the branches of neighbouring rays are predicted well, and a ray
/// begins before the one before it has ended: the stream is 10 to 30 % slower on coherent rays.
constexpr std::size_t kMaxCachedTreeBytes = std::size_t{64} << 20;

bool is_in(std::span<const PrimitiveId> ascending, PrimitiveId id) {
    return std::binary_search(ascending.begin(), ascending.end(), id);
}

bool packets_pay(const PrimitiveTable& table, const WideBvhLayout& layout,
                 std::span<const PrimitiveId> unbounded) {
    if (layout.memory_bytes() > kMaxPacketTreeBytes) return false;
    std::size_t in_lanes = 0, alone = 0;
    for (std::uint32_t i = 0; i < table.size(); ++i) {
        if (i == table.first(kTriangleKind)) {
            const std::uint32_t end = table.first(kTriangleKind + 1);
            in_lanes += end - i;
            i = end;
            if (i == table.size()) break;
        }
        const PrimitiveId id{i};
        if (is_in(unbounded, id)) continue;
        ++(takes_lanes(table, id) ? in_lanes : alone);
    }
    return kMinPrimitivesPerSingle * alone <= in_lanes;
}

}  // namespace

Schedules::Schedules(const PrimitiveTable& table, const WideBvhLayout& layout,
                     std::span<const PrimitiveId> unbounded)
    : treeless_(is_treeless(table, unbounded)),
      packets_(packets_pay(table, layout, unbounded)),
      cached_(layout.memory_bytes() <= kMaxCachedTreeBytes) {}

Schedule Schedules::closest(Coherence coherence) const {
    if (treeless_) return Schedule::Treeless;
    if (coherence == Coherence::Coherent && packets_) return Schedule::Packets;
    return coherence == Coherence::Coherent && cached_ ? Schedule::Single : Schedule::Stream;
}

// Packets answer nearest hits only: of shadow rays in packets those that are lost first cost the
// rest (three times slower, measured).
Schedule Schedules::occluded(Coherence coherence) const {
    if (treeless_) return Schedule::Treeless;
    return coherence == Coherence::Coherent && cached_ ? Schedule::Single : Schedule::Stream;
}

bool Schedules::is_treeless(const PrimitiveTable& table, std::span<const PrimitiveId> unbounded) {
    std::size_t shapes = 0;
    if (table.size() > kMaxTreelessShapes + unbounded.size()) return false;
    for (std::uint32_t i = 0; i < table.size(); ++i) {
        const PrimitiveId id{i};
        if (is_in(unbounded, id)) continue;
        const std::uint32_t kind = table.kind(id);
        const bool fits = kind < kTriangleKind && with_column(table.columns, kind, [](auto& c) {
                              return HasPacketTest<typename ShapeOfColumn<decltype(c)>::Type>;
                          });
        if (!fits) return false;
        ++shapes;
    }
    return shapes > 0;
}

}  // namespace alhazen
