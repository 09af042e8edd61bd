#pragma once
/// Treeless packets: batches of rays against a few shapes with a test of eight rays at a time
/// (shapes/core/first_hits.h). Traversal of the tree would take longer.
///
/// Conventions: those of `Aggregate::closest_batch`, for the shapes that are listed.
/// Complexity and threads: every ray is tested against every shape. Const functions may be called
/// from many threads.

#include <span>
#include <vector>

#include "alhazen/primitives/primitive_table.h"

namespace alhazen {

class TreelessPackets {
  public:
    TreelessPackets() = default;
    /// Of a finished table without the primitives `outside`: empty unless the rest are at most
    /// kMaxTreelessPrimitives shapes of kinds with a packet test.
    TreelessPackets(const PrimitiveTable& table, std::span<const PrimitiveId> outside);

    [[nodiscard]] bool empty() const { return ids_.empty(); }
    /// [ray] each; `best` may hold earlier hits.
    void closest(const PrimitiveTable& table, std::span<const Ray> rays, std::span<Hit> best,
                 RayQuery query) const;
    /// [ray] each; rays that are occluded already are skipped.
    void occluded(const PrimitiveTable& table, std::span<const Ray> rays, std::span<bool> occluded,
                  RayQuery query) const;

  private:
    std::vector<PrimitiveId> ids_;  ///< ascending
};

}  // namespace alhazen
