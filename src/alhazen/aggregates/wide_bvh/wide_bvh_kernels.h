#pragma once
/// Kernels of the wide BVH aggregate, compiled once per instruction set.

#include <atomic>
#include <cstdint>
#include <span>
#include <vector>

#include "alhazen/aggregates/wide_bvh/leaves/leaf_blocks.h"
#include "alhazen/primitives/primitive_table.h"

namespace alhazen {

/// What packets of earlier batches told: coherent_queries-inl.h.
using PacketFailures = std::atomic<std::uint32_t>;

/// The scene of a kernel, for rays with the mask `mask`.
class WideBvhScene {
  public:
    WideBvhScene(const PrimitiveTable& t, const WideBvhLayout& l, RayMask m = kAllRays)
        : table(&t), layout(&l), mask(m), all_seen_(t.all_seen(m)) {}

    const PrimitiveTable* table;
    const WideBvhLayout* layout;
    RayMask mask;
    PacketFailures* failures = nullptr;  ///< null: every batch begins anew

    [[nodiscard]] bool sees(PrimitiveId id) const {
        return all_seen_ || (table->visible_to(id) & mask) != 0;
    }

  private:
    bool all_seen_;  ///< every primitive is visible
};

/// The queries of `Aggregate` on the bounded primitives; the tree is not empty, hits are appended
/// unsorted. An invalid ray hits nothing. Statistics are ignored by kernels that do not count, and
/// not null for those that do.
struct WideBvhKernels {
    /// `best` may hold an earlier hit, and limits the search.
    void (*closest)(const WideBvhScene&, const Ray&, Hit& best, TraversalStats*);
    bool (*occluded)(const WideBvhScene&, const Ray&, TraversalStats*);
    /// Always false.
    bool (*all_hits)(const WideBvhScene&, const Ray&, std::vector<Hit>&, TraversalStats*);
    bool (*shadowed)(const WideBvhScene&, const Ray&, std::vector<Hit>&, TraversalStats*);
    /// [ray] each; `best` may hold earlier hits.
    void (*closest_batch)(const WideBvhScene&, std::span<const Ray>, std::span<Hit> best,
                          TraversalStats*);
    /// [ray] each; rays that are occluded already are skipped.
    void (*occluded_batch)(const WideBvhScene&, std::span<const Ray>, std::span<bool> occluded,
                           TraversalStats*);
    /// As the batches, by packets of coherent rays; null where the kernels have no packets.
    void (*closest_coherent)(const WideBvhScene&, std::span<const Ray>, std::span<Hit> best,
                             TraversalStats*);
    void (*occluded_coherent)(const WideBvhScene&, std::span<const Ray>, std::span<bool> occluded,
                              TraversalStats*);
};

struct WideBvhKernelPair {
    WideBvhKernels plain, counting;

    /// Those that count, where there are statistics.
    [[nodiscard]] const WideBvhKernels& for_stats(const TraversalStats* stats) const {
        return stats != nullptr ? counting : plain;
    }
};

/// Out of line: std::vector's code is not compiled for wide instruction sets.
void append_hit(std::vector<Hit>& hits, const ShapeHit& hit, PrimitiveId id);

/// The kernels for nodes of 4, 8 or 16 children, for the best instruction set of this machine or
/// the one that is forced (simd/targets.h). Precision::Fast is for nodes of 8 only, and makes
/// `closest`, `occluded` and their batches single-precision.
[[nodiscard]] WideBvhKernelPair wide_bvh_kernels(std::uint32_t width,
                                                 Precision precision = Precision::Robust);

/// The parts of the above, each with or without counting; in single precision without `all_hits`
/// and `shadowed`.
[[nodiscard]] const WideBvhKernels& wide_bvh_kernels_4();
[[nodiscard]] const WideBvhKernels& wide_bvh_kernels_4_counting();
[[nodiscard]] const WideBvhKernels& wide_bvh_kernels_8();
[[nodiscard]] const WideBvhKernels& wide_bvh_kernels_8_counting();
[[nodiscard]] const WideBvhKernels& wide_bvh_kernels_16();
[[nodiscard]] const WideBvhKernels& wide_bvh_kernels_16_counting();
[[nodiscard]] const WideBvhKernels& wide_bvh_kernels_fast();
[[nodiscard]] const WideBvhKernels& wide_bvh_kernels_fast_counting();

}  // namespace alhazen
