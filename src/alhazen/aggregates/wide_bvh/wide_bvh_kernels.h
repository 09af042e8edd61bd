#pragma once
/// Kernels of the wide BVH aggregate, compiled once per instruction set.

#include <atomic>
#include <cstdint>
#include <span>
#include <vector>

#include "alhazen/aggregates/wide_bvh/leaves/leaf_blocks.h"
#include "alhazen/geometry/ray_columns.h"
#include "alhazen/primitives/primitive_table.h"

namespace alhazen {

class RecentOccluders;

/// Failures of packets of earlier batches: coherent_queries-inl.h.
using PacketFailures = std::atomic<std::uint32_t>;

/// The scene of a kernel, for rays with the mask `mask`.
class WideBvhScene {
  public:
    WideBvhScene(const PrimitiveTable& t, const WideBvhLayout& l, RayMask m = kAllRays)
        : table(&t), layout(&l), mask(m), all_seen_(t.all_seen(m)) {}

    const PrimitiveTable* table;
    const WideBvhLayout* layout;
    RayMask mask;
    PacketFailures* failures = nullptr;  ///< null: each batch starts without failures
    RecentOccluders* recent = nullptr;   ///< of a batch whose rays are traced one by one
    bool others_alone = false;           ///< see Schedules
    /// A leaf of triangles among the children of the root whose box is about as large as the
    /// root's, as that of the walls of a room: the bits of its reference, and that of its slot, or
    /// 0.
    std::uint32_t largest_leaf = 0, largest_leaf_slot = 0;
    bool waits = false;  ///< rays that leave a packet in lanes are traced several in turn

    /// Whether the rays see every primitive.
    [[nodiscard]] bool sees_all() const { return all_seen_; }
    [[nodiscard]] bool sees(PrimitiveId id) const {
        return all_seen_ || (table->visible_to(id) & mask) != 0;
    }

    /// Sets `largest_leaf`. Precondition: the layout is complete.
    void find_largest_leaf();

    /// Has the indices of a candidate's vertices fetched if its block holds them rounded.
    void expect(BlockId triangle) const {
        if (!triangle.exact()) [[unlikely]] {
            expect_indices(triangle.id());
        }
    }

  private:
    void expect_indices(PrimitiveId id) const;

    bool all_seen_;
};

/// The queries of `Aggregate` on the bounded primitives. Precondition: the tree is not empty. Hits
/// are appended unsorted; an invalid ray hits nothing. Statistics: not null for kernels that count,
/// ignored by the others.
struct WideBvhKernels {
    /// Sets the hit, and returns whether there is one.
    bool (*closest_of_one)(const WideBvhScene&, const Ray&, Hit&, TraversalStats*);
    /// `best` may hold an earlier hit, and limits the search.
    void (*closest)(const WideBvhScene&, const Ray&, Hit& best, TraversalStats*);
    bool (*occluded)(const WideBvhScene&, const Ray&, TraversalStats*);
    /// Always returns false.
    bool (*all_hits)(const WideBvhScene&, const Ray&, std::vector<Hit>&, TraversalStats*);
    bool (*shadowed)(const WideBvhScene&, const Ray&, std::vector<Hit>&, TraversalStats*);
    /// For each ray; `best` may hold earlier hits.
    void (*closest_batch)(const WideBvhScene&, std::span<const Ray>, std::span<Hit> best,
                          TraversalStats*);
    /// For each ray; skips rays that are already occluded.
    void (*occluded_batch)(const WideBvhScene&, std::span<const Ray>, std::span<bool> occluded,
                           TraversalStats*);
    /// As the batches, by packets of coherent rays; null in kernels without packets. `unset`:
    /// `best` holds nothing, and is set for each ray.
    void (*closest_coherent)(const WideBvhScene&, std::span<const Ray>, std::span<Hit> best,
                             bool unset, TraversalStats*);
    void (*occluded_coherent)(const WideBvhScene&, std::span<const Ray>, std::span<bool> occluded,
                              TraversalStats*);
    /// The same for rays in columns. Every result is set, or false is returned and nothing done:
    /// the tree has no packets in lanes.
    bool (*closest_columns)(const WideBvhScene&, const RayColumns&, const HitColumns&,
                            TraversalStats*);
    bool (*occluded_columns)(const WideBvhScene&, const RayColumns&, std::span<bool> occluded,
                             TraversalStats*);
    /// The batches for rays in columns.
    void (*closest_column_stream)(const WideBvhScene&, const RayColumns&, std::span<Hit> best,
                                  TraversalStats*);
    void (*occluded_column_stream)(const WideBvhScene&, const RayColumns&, std::span<bool> occluded,
                                   TraversalStats*);
};

struct WideBvhKernelPair {
    WideBvhKernels plain, counting;

    /// The kernels that count if there are statistics.
    [[nodiscard]] const WideBvhKernels& for_stats(const TraversalStats* stats) const {
        return stats != nullptr ? counting : plain;
    }
};

/// Out of line, so that std::vector's code is not compiled for wide instruction sets.
void append_hit(std::vector<Hit>& hits, const ShapeHit& hit, PrimitiveId id);

/// The kernels for nodes of 4, 8 or 16 children, for the best instruction set of this machine or
/// the forced one (simd/targets.h). Precision::Fast requires nodes of 8, and makes `closest`,
/// `occluded` and their batches single-precision.
[[nodiscard]] WideBvhKernelPair wide_bvh_kernels(std::uint32_t width,
                                                 Precision precision = Precision::Robust);

/// The parts of wide_bvh_kernels, each with or without counting; those in single precision have no
/// `all_hits` and `shadowed`.
[[nodiscard]] const WideBvhKernels& wide_bvh_kernels_4();
[[nodiscard]] const WideBvhKernels& wide_bvh_kernels_4_counting();
[[nodiscard]] const WideBvhKernels& wide_bvh_kernels_8();
[[nodiscard]] const WideBvhKernels& wide_bvh_kernels_8_counting();
[[nodiscard]] const WideBvhKernels& wide_bvh_kernels_16();
[[nodiscard]] const WideBvhKernels& wide_bvh_kernels_16_counting();
[[nodiscard]] const WideBvhKernels& wide_bvh_kernels_fast();
[[nodiscard]] const WideBvhKernels& wide_bvh_kernels_fast_counting();

}  // namespace alhazen
