#include "alhazen/scene/wide_bvh_kernels.h"

#include <bit>

#include "alhazen/geometry/sphere_roots.h"

// Compiles the rest of this file once per target.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "alhazen/scene/wide_bvh_kernels.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// After foreach_target.h.
#include "alhazen/accel/wide_bvh/traverse-inl.h"
#include "alhazen/simd/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {
namespace {

#include "alhazen/geometry/sphere_roots_formula-inl.h"
#include "alhazen/geometry/watertight_triangle_formulas-inl.h"

/// The constants of the block tests in every lane.
struct BlockRay {
    // Triangles, with axes in the order of the shear.
    Doubles kx_origin, ky_origin, kz_origin, sx, sy;
    int kx, ky, kz;
    // Spheres.
    Doubles origin[3], direction[3], length_squared, t_min;

    HWY_INLINE BlockRay(const Ray& ray, const RayShear& shear)
        : kx_origin(ray.origin[shear.kx]),
          ky_origin(ray.origin[shear.ky]),
          kz_origin(ray.origin[shear.kz]),
          sx(shear.sx),
          sy(shear.sy),
          kx(shear.kx),
          ky(shear.ky),
          kz(shear.kz),
          length_squared(dot(ray.direction, ray.direction)),
          t_min(ray.t_min) {
        for (int k = 0; k < 3; ++k) {
            origin[k] = Doubles(ray.origin[k]);
            direction[k] = Doubles(ray.direction[k]);
        }
    }
};

// The block tests are calls: one copy of them per target in place of eight costs nothing that could
// be measured, and compiles in a fraction of the time.

/// Bits of the triangles whose edges the ray does not pass on both sides: the first test of
/// `intersect_triangle`, with the same bits.
HWY_NOINLINE std::uint32_t candidates(const TriangleBlock& block, const BlockRay& ray, double) {
    ShearedVertex<Doubles> v[3];
    HWY_UNROLL(3)
    for (int i = 0; i < 3; ++i) {
        v[i] = sheared(load_lanes(block.vertex[i][ray.kx]), load_lanes(block.vertex[i][ray.ky]),
                       load_lanes(block.vertex[i][ray.kz]), ray.kx_origin, ray.ky_origin,
                       ray.kz_origin, ray.sx, ray.sy);
    }
    const Doubles eu = edge_function(v[1], v[2]);
    const Doubles ev = edge_function(v[2], v[0]);
    const Doubles ew = edge_function(v[0], v[1]);
    const Doubles zero(0.0);
    const std::uint32_t negative = bits_of((eu < zero) | (ev < zero) | (ew < zero));
    const std::uint32_t positive = bits_of((eu > zero) | (ev > zero) | (ew > zero));
    return block.ids.lanes & ~(negative & positive);
}

/// Bits of the spheres that the ray meets between its t_min and `t_max`, as `Sphere::intersect`
/// decides it.
HWY_NOINLINE std::uint32_t candidates(const SphereBlock& block, const BlockRay& ray, double t_max) {
    const Doubles fx = ray.origin[0] - load_lanes(block.center[0]);
    const Doubles fy = ray.origin[1] - load_lanes(block.center[1]);
    const Doubles fz = ray.origin[2] - load_lanes(block.center[2]);
    const Doubles radius = load_lanes(block.radius);
    const SphereLine<Doubles> line =
        sphere_line(ray.direction[0], ray.direction[1], ray.direction[2], ray.length_squared, fx,
                    fy, fz, radius);
    const std::uint32_t missed = bits_of(line.discriminant < Doubles(0.0));
    // Most blocks are missed altogether: their roots are not worth the square roots.
    if ((block.ids.lanes & ~missed) == 0) return 0;
    const SphereRoots<Doubles> roots = sphere_roots(line, ray.length_squared, fx, fy, fz, radius);
    const Doubles last(t_max);
    const std::uint32_t met = bits_of((ray.t_min <= roots.t_near) & (roots.t_near <= last)) |
                              bits_of((ray.t_min <= roots.t_far) & (roots.t_far <= last));
    return block.ids.lanes & met & ~missed;
}

/// Calls query(block, lane, stats) for the candidates of a leaf until it returns true.
template <class Block, class Query, class Stats>
HWY_INLINE bool visit_blocks(const Block* blocks, std::uint32_t count, const BlockRay& ray,
                             Query& query, Stats stats) {
    for (std::uint32_t i = 0; i < count; ++i) {
        const Block& block = blocks[i];
        std::uint32_t rest = candidates(block, ray, query.ray.t_max);
        // The query counts the candidates.
        stats.primitives(static_cast<std::uint64_t>(std::popcount(block.ids.lanes & ~rest)));
        for (; rest != 0; rest &= rest - 1) {
            if (query(block, static_cast<std::size_t>(std::countr_zero(rest)), stats)) return true;
        }
    }
    return false;
}

/// What happens in a leaf: the blocks sift, `Query` tests what is left.
template <class Query, class Stats>
struct LeafVisitor {
    const WideBvhLayout& layout;
    const BlockRay& ray;
    Query& query;
    Stats stats;

    HWY_INLINE bool visit(NodeRef ref) {
        const std::uint32_t count = ref.count();
        switch (static_cast<LeafType>(ref.kind())) {
            case LeafType::Triangles:
                return visit_blocks(&layout.triangles[ref.offset()], count, ray, query, stats);
            case LeafType::Spheres:
                return visit_blocks(&layout.spheres[ref.offset()], count, ray, query, stats);
            case LeafType::Others:
                break;
        }
        const PrimitiveId* ids = &layout.others[ref.offset()];
        for (std::uint32_t i = 0; i < count; ++i) {
            if (query(ids[i], stats)) return true;
        }
        return false;
    }
    HWY_INLINE float s_max() const { return query.s_max; }
};

template <class Stats>
HWY_INLINE bool hit_triangle(const TriangleBlock& block, std::size_t lane, const Ray& ray,
                             const RayShear& shear, ShapeHit& hit, Stats stats) {
    stats.primitives(1);
    if (!intersect_triangle(ray, shear, block.corner(0, lane), block.corner(1, lane),
                            block.corner(2, lane), hit)) {
        return false;
    }
    stats.primitive_hits(1);
    return true;
}

struct ClosestQuery {
    static constexpr bool kOrdered = true;
    const PrimitiveTable& table;
    Ray& ray;
    const RayShear& shear;
    const SlabRay& slab_ray;
    Hit& best;
    float s_max;

    template <class Stats>
    HWY_INLINE bool operator()(const TriangleBlock& block, std::size_t lane, Stats stats) {
        ShapeHit hit;
        if (!hit_triangle(block, lane, ray, shear, hit, stats)) return false;
        offer(hit, block.ids.id[lane], ray, best);
        s_max = slab_ray.local_max(ray.t_max);
        return false;
    }
    template <class Stats>
    HWY_INLINE bool operator()(const SphereBlock& block, std::size_t lane, Stats stats) {
        return (*this)(block.ids.id[lane], stats);
    }
    template <class Stats>
    HWY_INLINE bool operator()(PrimitiveId id, Stats stats) {
        table.closest(id, ray, shear, best, stats);
        s_max = slab_ray.local_max(ray.t_max);
        return false;
    }
};

struct OccludedQuery {
    static constexpr bool kOrdered = false;
    const PrimitiveTable& table;
    const Ray& ray;
    const RayShear& shear;
    float s_max;

    template <class Stats>
    HWY_INLINE bool operator()(const TriangleBlock& block, std::size_t lane, Stats stats) {
        ShapeHit hit;
        return hit_triangle(block, lane, ray, shear, hit, stats);
    }
    template <class Stats>
    HWY_INLINE bool operator()(const SphereBlock& block, std::size_t lane, Stats stats) {
        return (*this)(block.ids.id[lane], stats);
    }
    template <class Stats>
    HWY_INLINE bool operator()(PrimitiveId id, Stats stats) {
        return table.occluded(id, ray, shear, stats);
    }
};

/// All hits; with `kStopAtOpaque` up to the first opaque one.
template <bool kStopAtOpaque>
struct CollectQuery {
    static constexpr bool kOrdered = false;
    const PrimitiveTable& table;
    const Ray& ray;
    const RayShear& shear;
    std::vector<Hit>& hits;
    float s_max;

    template <class Stats>
    HWY_INLINE bool operator()(const TriangleBlock& block, std::size_t lane, Stats stats) {
        ShapeHit hit;
        if (!hit_triangle(block, lane, ray, shear, hit, stats)) return false;
        if (kStopAtOpaque) {
            if ((block.ids.opaque >> lane & 1) != 0) return true;
            const auto effect = table.shadow_effect(block.ids.id[lane], ray);
            if (effect != PrimitiveTable::ShadowEffect::Tints) {
                return effect == PrimitiveTable::ShadowEffect::Blocks;
            }
        }
        append_hit(hits, hit, block.ids.id[lane]);
        return false;
    }
    template <class Stats>
    HWY_INLINE bool operator()(const SphereBlock& block, std::size_t lane, Stats stats) {
        const PrimitiveId id = block.ids.id[lane];
        if (kStopAtOpaque && (block.ids.opaque >> lane & 1) != 0) {
            return table.occluded(id, ray, shear, stats);
        }
        table.all_hits(id, ray, shear, hits, stats);
        return false;
    }
    template <class Stats>
    HWY_INLINE bool operator()(PrimitiveId id, Stats stats) {
        if (kStopAtOpaque) return table.shadowed(id, ray, shear, hits, stats);
        table.all_hits(id, ray, shear, hits, stats);
        return false;
    }
};

template <class Query>
HWY_INLINE bool run(const WideBvhScene& scene, const Ray& ray, const RayShear& shear,
                    const SlabRay& slab_ray, Query& query, TraversalStats* stats) {
    const WideBvhLayout& layout = *scene.layout;
    const BlockRay block_ray(ray, shear);
    const auto walk = [&](auto policy) HWY_ATTR {
        LeafVisitor<Query, decltype(policy)> leaf{layout, block_ray, query, policy};
        return traverse<Query::kOrdered>(layout.tree.nodes.data(), layout.tree.root, slab_ray, leaf,
                                         policy);
    };
    return stats != nullptr ? walk(CountingStats{stats}) : walk(NoStats{});
}

void closest(const WideBvhScene& scene, Ray& ray, const RayShear& shear, Hit& best,
             TraversalStats* stats) {
    const SlabRay slab_ray(scene.layout->frame, ray);
    ClosestQuery query{*scene.table, ray, shear, slab_ray, best, slab_ray.s_max};
    run(scene, ray, shear, slab_ray, query, stats);
}

bool occluded(const WideBvhScene& scene, const Ray& ray, const RayShear& shear,
              TraversalStats* stats) {
    const SlabRay slab_ray(scene.layout->frame, ray);
    OccludedQuery query{*scene.table, ray, shear, slab_ray.s_max};
    return run(scene, ray, shear, slab_ray, query, stats);
}

template <bool kStopAtOpaque>
bool collect(const WideBvhScene& scene, const Ray& ray, const RayShear& shear,
             std::vector<Hit>& hits, TraversalStats* stats) {
    const SlabRay slab_ray(scene.layout->frame, ray);
    CollectQuery<kStopAtOpaque> query{*scene.table, ray, shear, hits, slab_ray.s_max};
    return run(scene, ray, shear, slab_ray, query, stats);
}

}  // namespace

const WideBvhKernels& kernels() {
    static constexpr WideBvhKernels kernels{&closest, &occluded, &collect<false>, &collect<true>};
    return kernels;
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace alhazen {

HWY_EXPORT(kernels);

const WideBvhKernels& wide_bvh_kernels() {
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    return HWY_DYNAMIC_DISPATCH(kernels)();
}

}  // namespace alhazen
#endif
