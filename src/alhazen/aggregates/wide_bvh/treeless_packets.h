#pragma once
/// Treeless packets: tests batches of rays, eight rays at a time, against each of a few shapes
/// (shapes/core/first_hits.h), for scenes in which traversal of the tree takes longer.
///
/// Conventions: those of `Aggregate::closest_batch`, for the shapes in the list.
/// Complexity and threads: every ray is tested against every shape. Const functions may be called
/// from many threads.

#include <span>
#include <vector>

#include "alhazen/primitives/primitive_table.h"

namespace alhazen {

class TreelessPackets {
  public:
    TreelessPackets() = default;
    /// `table` is finished. Takes all its primitives except `outside` if they are at most
    /// kMaxTreelessPrimitives shapes of kinds with a packet test, else none.
    TreelessPackets(const PrimitiveTable& table, std::span<const PrimitiveId> outside);

    [[nodiscard]] bool empty() const { return ids_.empty(); }
    /// For each ray; `best` may hold earlier hits.
    void closest(const PrimitiveTable& table, std::span<const Ray> rays, std::span<Hit> best,
                 RayQuery query) const;
    /// For each ray; skips rays that are already occluded.
    void occluded(const PrimitiveTable& table, std::span<const Ray> rays, std::span<bool> occluded,
                  RayQuery query) const;

  private:
    std::vector<PrimitiveId> ids_;  ///< ascending
};

}  // namespace alhazen
