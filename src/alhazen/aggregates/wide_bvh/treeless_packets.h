#pragma once
/// Batches of rays against few shapes whose first crossings are found for eight rays at a time
/// (shapes/core/first_hits.h): without the tree, which would take longer than their lanes to miss.
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
    /// Of a finished table without the primitives `outside`: empty, unless the rest are few shapes
    /// of such kinds.
    TreelessPackets(const PrimitiveTable& table, std::span<const PrimitiveId> outside);

    [[nodiscard]] bool empty() const { return ids_.empty(); }
    /// [ray] each; `best` may hold hits found before.
    void closest(const PrimitiveTable& table, std::span<const Ray> rays, std::span<Hit> best,
                 RayQuery query) const;
    /// [ray] each; what is true already stays so.
    void occluded(const PrimitiveTable& table, std::span<const Ray> rays, std::span<bool> occluded,
                  RayQuery query) const;

  private:
    std::vector<PrimitiveId> ids_;  ///< ascending
};

}  // namespace alhazen
