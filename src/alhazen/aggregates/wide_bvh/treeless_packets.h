#pragma once
/// Batches of rays against few shapes, eight rays at a time (shapes/core/first_hits.h), without a
/// tree. schedule.h says when.
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
    /// Of a finished table without the primitives `outside`, which ascend; all others are shapes
    /// with a packet test.
    TreelessPackets(const PrimitiveTable& table, std::span<const PrimitiveId> outside);

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
