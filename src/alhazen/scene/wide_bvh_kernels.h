#pragma once
/// The queries of the wide BVH aggregate, compiled once per instruction set.

#include <vector>

#include "alhazen/scene/leaf_blocks.h"
#include "alhazen/scene/primitive_table.h"

namespace alhazen {

/// What a kernel works on.
struct WideBvhScene {
    const PrimitiveTable* table;
    const WideBvhLayout* layout;
};

/// The queries of `Aggregate` on the bounded primitives; the ray is valid, the tree not empty,
/// `stats` may be null, hits are appended unsorted. `best` and `ray.t_max` may hold a hit found
/// before.
struct WideBvhKernels {
    void (*closest)(const WideBvhScene&, Ray& ray, const RayShear&, Hit& best, TraversalStats*);
    bool (*occluded)(const WideBvhScene&, const Ray&, const RayShear&, TraversalStats*);
    /// Always false.
    bool (*all_hits)(const WideBvhScene&, const Ray&, const RayShear&, std::vector<Hit>&,
                     TraversalStats*);
    bool (*shadowed)(const WideBvhScene&, const Ray&, const RayShear&, std::vector<Hit>&,
                     TraversalStats*);
};

/// Out of line, so that no copy of std::vector's code is made for a wide instruction set.
void append_hit(std::vector<Hit>& hits, const ShapeHit& hit, PrimitiveId id);

/// Those for the best instruction set of this machine, or the one that is forced (simd/targets.h).
[[nodiscard]] const WideBvhKernels& wide_bvh_kernels();

}  // namespace alhazen
