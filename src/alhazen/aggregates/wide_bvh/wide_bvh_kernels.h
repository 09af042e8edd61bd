#pragma once
/// The queries of the wide BVH aggregate, compiled once per instruction set.

#include <span>
#include <vector>

#include "alhazen/aggregates/wide_bvh/leaf_blocks.h"
#include "alhazen/primitives/primitive_table.h"

namespace alhazen {

/// What a kernel works on, for rays that see what `mask` says.
class WideBvhScene {
  public:
    WideBvhScene(const PrimitiveTable& t, const WideBvhLayout& l, RayMask m = kAllRays)
        : table(&t), layout(&l), mask(m), all_seen_(t.all_seen(m)) {}

    const PrimitiveTable* table;
    const WideBvhLayout* layout;
    RayMask mask;

    [[nodiscard]] bool sees(PrimitiveId id) const {
        return all_seen_ || (table->visible_to(id) & mask) != 0;
    }

  private:
    bool all_seen_;  ///< the rays see every primitive
};

/// The queries of `Aggregate` on the bounded primitives; the tree is not empty, `stats` may be
/// null, hits are appended unsorted. An invalid ray hits nothing.
struct WideBvhKernels {
    /// `best` may hold a hit found before: farther ones are not looked for.
    void (*closest)(const WideBvhScene&, const Ray&, Hit& best, TraversalStats*);
    bool (*occluded)(const WideBvhScene&, const Ray&, TraversalStats*);
    /// Always false.
    bool (*all_hits)(const WideBvhScene&, const Ray&, std::vector<Hit>&, TraversalStats*);
    bool (*shadowed)(const WideBvhScene&, const Ray&, std::vector<Hit>&, TraversalStats*);
    /// [ray] each; `best` may hold hits found before.
    void (*closest_batch)(const WideBvhScene&, std::span<const Ray>, std::span<Hit> best,
                          TraversalStats*);
    /// [ray] each; what is true already stays so.
    void (*occluded_batch)(const WideBvhScene&, std::span<const Ray>, std::span<bool> occluded,
                           TraversalStats*);
    /// The nearest hits, fast where neighbours go nearly the same way.
    void (*closest_coherent)(const WideBvhScene&, std::span<const Ray>, std::span<Hit> best,
                             TraversalStats*);
};

/// Out of line, so that no copy of std::vector's code is made for a wide instruction set.
void append_hit(std::vector<Hit>& hits, const ShapeHit& hit, PrimitiveId id);

/// Those for the best instruction set of this machine, or the one that is forced (simd/targets.h),
/// and nodes of 4, 8 or 16 children.
[[nodiscard]] const WideBvhKernels& wide_bvh_kernels(std::uint32_t width);
[[nodiscard]] const WideBvhKernels& wide_bvh_kernels_4();
[[nodiscard]] const WideBvhKernels& wide_bvh_kernels_16();
/// Those for nodes of 8, but that float decides about triangles in the first two queries and their
/// batches.
[[nodiscard]] const WideBvhKernels& wide_bvh_fast_kernels();

}  // namespace alhazen
