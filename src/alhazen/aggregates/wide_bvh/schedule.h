#pragma once
/// Chooses how a batch of rays is traced: the one place that holds the thresholds.
///
/// Schedules give the same hits, bit for bit; they differ in time only. Measurements: docs/log.
/// Threads: const functions may be called from many threads.

#include <span>

#include "alhazen/aggregates/wide_bvh/leaf_blocks.h"
#include "alhazen/primitives/aggregate.h"
#include "alhazen/primitives/primitive_table.h"

namespace alhazen {

enum class Schedule {
    Single,    ///< ray by ray
    Stream,    ///< eight rays interleaved: one ray's arithmetic hides the memory latency of others
    Packets,   ///< 64 coherent rays as one pyramid; those that fit in none ray by ray
    Treeless,  ///< eight rays in lanes against every shape, no tree
};

class Schedules {
  public:
    Schedules() = default;
    /// Of a finished table and the tree over it; `unbounded`, ascending, is not in the tree.
    Schedules(const PrimitiveTable& table, const WideBvhLayout& layout,
              std::span<const PrimitiveId> unbounded);

    /// The schedule of `closest_batch`.
    [[nodiscard]] Schedule closest(Coherence coherence) const;
    /// The schedule of `occluded_batch`.
    [[nodiscard]] Schedule occluded(Coherence coherence) const;

    /// Whether a table is traced without its tree: at most `kMaxTreelessShapes` shapes, each with a
    /// packet test, and nothing else beside `unbounded`.
    [[nodiscard]] static bool is_treeless(const PrimitiveTable& table,
                                          std::span<const PrimitiveId> unbounded);

  private:
    bool treeless_ = false;
    bool packets_ = false;  ///< packets of coherent rays are faster than single rays
    bool cached_ = false;   ///< coherent rays are faster one by one than in the stream
};

}  // namespace alhazen
