/// The addresses of nodes and leaves of a tree, for rays that have them fetched ahead.
///
/// Conventions: included once per target (see simd/lanes-inl.h).

#if defined(ALHAZEN_AGGREGATES_WIDE_BVH_LEAVES_LEAF_PREFETCH_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ALHAZEN_AGGREGATES_WIDE_BVH_LEAVES_LEAF_PREFETCH_INL_H_
#undef ALHAZEN_AGGREGATES_WIDE_BVH_LEAVES_LEAF_PREFETCH_INL_H_
#else
#define ALHAZEN_AGGREGATES_WIDE_BVH_LEAVES_LEAF_PREFETCH_INL_H_
#endif

#include "alhazen/accel/wide_bvh/trace/stream-inl.h"
#include "alhazen/aggregates/wide_bvh/leaves/leaf_blocks.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {

template <std::size_t W>
HWY_INLINE PrefetchTable prefetch_table_of(const WideBvhLayout& layout) {
    const bool indexed = layout.is_indexed();
    const void* triangles = layout.triangles.data();
    if (indexed) triangles = layout.indices.data();
    return {nodes_of<W>(layout.tree).data(),
            {triangles, layout.spheres.data(), layout.frustums.data(), layout.others.data()},
            {indexed ? sizeof(IndexBlock) : sizeof(TriangleBlock), sizeof(SphereBlock),
             sizeof(FrustumBlock), sizeof(BoxBlock)}};
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#endif  // include guard that opens again for every target
