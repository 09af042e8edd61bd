/// The shapes in the leaves of a packet of rays in lanes: the filter of each against all rays, then
/// the test in double, eight rays at a time or one by one.
///
/// Source: lane_filter-inl.h, shapes/span_lanes-inl.h, shapes/polygons/polygon_lanes.h: the bits
/// are those of single rays. Conventions: included once per target (see simd/lanes-inl.h).

#if defined(ALHAZEN_AGGREGATES_WIDE_BVH_PACKETS_LANE_SHAPES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ALHAZEN_AGGREGATES_WIDE_BVH_PACKETS_LANE_SHAPES_INL_H_
#undef ALHAZEN_AGGREGATES_WIDE_BVH_PACKETS_LANE_SHAPES_INL_H_
#else
#define ALHAZEN_AGGREGATES_WIDE_BVH_PACKETS_LANE_SHAPES_INL_H_
#endif

#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <type_traits>

#include "alhazen/accel/wide_bvh/trace/lane_packet-inl.h"
#include "alhazen/aggregates/wide_bvh/exact_resolution-inl.h"
#include "alhazen/aggregates/wide_bvh/leaves/block_boxes-inl.h"
#include "alhazen/aggregates/wide_bvh/leaves/leaf_bounds.h"
#include "alhazen/aggregates/wide_bvh/lone_ray-inl.h"
#include "alhazen/aggregates/wide_bvh/packets/lane_filter-inl.h"
#include "alhazen/aggregates/wide_bvh/wide_bvh_kernels.h"
#include "alhazen/shapes/polygons/polygon_lanes.h"
#include "alhazen/shapes/span_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {

/// The first crossings of eight rays with a shape.
struct GroupHits {
    ShapeHit of_ray[kRayLanes];
    std::uint32_t hit = 0, unsure = 0;  ///< as in LaneCrossings

    HWY_INLINE void set(const LaneCrossings& found) {
        hit = found.hit;
        unsure = found.unsure;
        if (hit == 0) return;
        alignas(64) double t[kRayLanes], part[kRayLanes];
        store_lanes(found.t, t);
        store_lanes(found.part, part);
        for_each_lane(hit, [&](std::size_t i) {
            of_ray[i] = {t[i], 0, 0, static_cast<std::uint32_t>(part[i])};
        });
    }
};

/// `Derived` offers `sphere`, `first_of` and `shape` for one ray (lone_ray-inl.h), `accept` for a
/// hit (lane_leaves-inl.h), which return true if the ray needs no more; and `left()` when a leaf
/// has limited rays.
template <class Derived>
class LaneShapes {
  public:
    HWY_INLINE LaneShapes(const WideBvhScene& scene, const GivenRays& rays, LanePacket& packet)
        : scene_(scene), rays_(rays), packet_(packet) {}

  protected:
    HWY_INLINE Derived& derived() { return static_cast<Derived&>(*this); }

    /// Each shape against all rays, the nearest first where that matters.
    template <class Block, class Stats>
    HWY_NOINLINE void visit_shapes(const Block* blocks, std::uint32_t count, std::uint32_t lanes,
                                   Stats stats) {
        for (std::uint32_t n = 0; n < count && lanes != 0; ++n) {
            const Block& block = blocks[n];
            const BlockBoxes boxes(block);
            Floats entries;
            std::uint32_t met = packet_.intersect_boxes(boxes.rows(), entries);
            HWY_ALIGN float entry[kBlockWidth];
            store_lanes(entries, entry);
            if (std::popcount(lanes) < kRaysPerShape * std::popcount(met)) {
                visit_by_rays(block, met, entry, lanes, stats);
                continue;
            }
            while (met != 0 && lanes != 0) {
                auto lane = static_cast<std::size_t>(std::countr_zero(met));
                if constexpr (Derived::kOrdered) lane = lane_of_least(met, entry);
                met &= ~(1u << lane);
                const PrimitiveId id = block.ids[lane].id();
                if (!block.ids[lane].used() || !scene_.sees(id)) continue;
                std::uint32_t sure;
                std::uint32_t rest =
                    filter_lanes<!Derived::kOrdered>(block, lane, packet_, lanes, sure);
                stats.primitives(static_cast<std::uint64_t>(std::popcount(lanes & ~rest)));
                if constexpr (!Derived::kOrdered) {
                    stats.primitives(static_cast<std::uint64_t>(std::popcount(sure)));
                    stats.primitive_hits(static_cast<std::uint64_t>(std::popcount(sure)));
                    derived().drop_all(sure);
                    lanes &= ~sure;
                    rest &= ~sure;
                    if (rest == 0) continue;
                    if ((block.may_be_sure() >> lane & 1) != 0 &&
                        derived().put_off(block, lane, rest)) {
                        expect_shape(scene_, block, lane);
                        continue;
                    }
                }
                lanes &= ~meet(block, lane, rest, stats);
            }
        }
        derived().left();
    }
    /// The same for few rays: each against all shapes. `met`: bits of the shapes to test, `entry`:
    /// where the frustum enters their boxes.
    template <class Block, class Stats>
    HWY_NOINLINE void visit_by_rays(const Block& block, std::uint32_t met, const float* entry,
                                    std::uint32_t& lanes, Stats stats) {
        std::uint32_t seen = 0;
        alignas(64) PacketRow begin[Derived::kOrdered ? kBlockWidth : 1];
        for (; met != 0; met &= met - 1) {
            const auto lane = static_cast<std::size_t>(std::countr_zero(met));
            if (!block.ids[lane].used() || !scene_.sees(block.ids[lane].id())) continue;
            seen |= 1u << lane;
            // Of rays that miss the shape.
            if constexpr (Derived::kOrdered) store_lanes(PacketFloats(0.0f), begin[lane]);
        }
        FilteredShapes filtered[kPacketLanes];
        std::uint32_t passed[kPacketLanes];
        filter_by_rays(block, lanes, filtered, passed);
        std::uint32_t rays_at[kBlockWidth] = {}, any = 0;  // [shape] the rays that may hit it
        for (std::uint32_t rays = lanes; rays != 0; rays &= rays - 1) {
            const auto i = static_cast<std::size_t>(std::countr_zero(rays));
            const FilteredShapes& found = filtered[i];
            stats.primitives(filtered_out(block, passed[i]));
            std::uint32_t rest = passed[i] & seen;
            if (rest == 0) continue;
            if (take_sure(i, found, found.sure & rest, stats)) {
                lanes &= ~(1u << i);
                continue;
            }
            any |= rest;
            for (; rest != 0; rest &= rest - 1) {
                const auto lane = static_cast<std::size_t>(std::countr_zero(rest));
                if constexpr (Derived::kOrdered) begin[lane][i] = found.lo[lane];
                rays_at[lane] |= 1u << i;
            }
        }
        while (any != 0) {
            auto lane = static_cast<std::size_t>(std::countr_zero(any));
            if constexpr (Derived::kOrdered) lane = lane_of_least(any, entry);
            any &= ~(1u << lane);
            std::uint32_t rest = rays_at[lane];
            if constexpr (Derived::kOrdered) {
                // Written so that a NaN is not passed over.
                const std::uint32_t beyond =
                    rest & bits_of(load_row(begin[lane]) > load_row(packet_.s_max));
                stats.primitives(static_cast<std::uint64_t>(std::popcount(beyond)));
                rest &= ~beyond;
            } else {
                rest &= lanes;
                if (rest != 0 && (block.may_be_sure() >> lane & 1) != 0 &&
                    derived().put_off(block, lane, rest)) {
                    expect_shape(scene_, block, lane);
                    continue;
                }
            }
            lanes &= ~meet(block, lane, rest, stats);
        }
    }
    /// The filter of a block for single rays; [ray] what it finds. Nothing branches on that.
    template <class Block>
    HWY_INLINE void filter_by_rays(const Block& block, std::uint32_t lanes,
                                   FilteredShapes (&filtered)[kPacketLanes],
                                   std::uint32_t (&passed)[kPacketLanes]) {
        const bool pairs =
            kPairsRays && packet_.edge_slack < std::numeric_limits<float>::infinity();
        while (lanes != 0) {
            const auto i = static_cast<std::size_t>(std::countr_zero(lanes));
            lanes &= lanes - 1;
            TriangleFilterRay ray;
            make_lone_filter_ray(packet_, i, ray);
            const RayAtBlock<Block> first{block, ray, packet_.s_min[i], packet_.s_max[i],
                                          filtered[i]};
            if (!pairs || lanes == 0) {
                passed[i] = shape_candidates<true>(block, ray, first.s_min, first.s_max, first.out);
                continue;
            }
            const auto k = static_cast<std::size_t>(std::countr_zero(lanes));
            lanes &= lanes - 1;
            TriangleFilterRay other;
            make_lone_filter_ray(packet_, k, other);
            const RayAtBlock<Block> second{block, other, packet_.s_min[k], packet_.s_max[k],
                                           filtered[k]};
            const std::uint32_t both = shape_candidates(first, second);
            passed[i] = both & kAllLanes;
            passed[k] = both >> kBlockWidth;
        }
    }
    /// Shapes that a ray certainly hits. True if it needs no more.
    template <class Stats>
    HWY_INLINE bool take_sure(std::size_t i, const FilteredShapes& found, std::uint32_t sure,
                              Stats stats) {
        float s_max = packet_.s_max[i];
        for (; sure != 0; sure &= sure - 1) {
            const auto lane = static_cast<std::size_t>(std::countr_zero(sure));
            if (derived().sure(i, found.hi[lane], s_max, stats)) return true;
        }
        return false;
    }
    /// Tests a shape with rays. Returns those that need no more.
    template <class Block, class Stats>
    HWY_INLINE std::uint32_t meet(const Block& block, std::size_t lane, std::uint32_t rays,
                                  Stats stats) {
        if (rays == 0) return 0;
        const PrimitiveId id = block.ids[lane].id();
        if constexpr (std::is_same_v<Block, SphereBlock>) {
            return intersect_sphere(id, sphere_of(scene_, block, lane), rays, stats);
        } else if constexpr (std::is_same_v<Block, FrustumBlock>) {
            if ((block.balls >> lane & 1) != 0) {
                return intersect_sphere(id, sphere_of(scene_, block, lane), rays, stats);
            }
            return intersect_frustum(id, rays, stats);
        } else {
            return intersect_other(id, rays, stats);
        }
    }
    /// Calls test(i, s_max) ray by ray. Returns those for which it does, which need no more.
    template <class Test>
    HWY_INLINE std::uint32_t one_by_one(std::uint32_t lanes, Test&& test) {
        std::uint32_t done = 0;
        for (; lanes != 0; lanes &= lanes - 1) {
            const auto i = static_cast<std::size_t>(std::countr_zero(lanes));
            float s_max = packet_.s_max[i];
            if (test(i, s_max)) done |= 1u << i;
        }
        return done;
    }
    /// Tests a shape of a known kind. Returns the rays that need no more, as the others below.
    template <class S, class Stats>
    HWY_INLINE std::uint32_t intersect_first(PrimitiveId id, const S& shape, std::uint32_t lanes,
                                             Stats stats) {
        return one_by_one(lanes, [&](std::size_t i, float& s_max) HWY_ATTR {
            return derived().first_of(i, id, shape, s_max, stats);
        });
    }
    template <class Stats>
    HWY_INLINE std::uint32_t intersect_alone(PrimitiveId id, std::uint32_t lanes, Stats stats) {
        return one_by_one(lanes, [&](std::size_t i, float& s_max)
                                     HWY_ATTR { return derived().shape(i, id, s_max, stats); });
    }
    template <class Stats>
    HWY_NOINLINE std::uint32_t intersect_sphere(PrimitiveId id, const Sphere& sphere,
                                                std::uint32_t lanes, Stats stats) {
        const std::uint32_t done = intersect_together(
            id, lanes,
            [&](const RayLanes& rays, std::uint32_t wanted, GroupHits& hits) HWY_ATTR {
                LaneCrossings found;
                find_first_crossings(rays, sphere, wanted, found);
                hits.set(found);
            },
            stats);
        return done | one_by_one(lanes, [&](std::size_t i, float& s_max) HWY_ATTR {
                   return derived().sphere(i, id, sphere, s_max, stats);
               });
    }
    template <class Stats>
    HWY_NOINLINE std::uint32_t intersect_frustum(PrimitiveId id, std::uint32_t lanes, Stats stats) {
        std::uint32_t done = 0;
        const auto meet = [&](const auto& shape) HWY_ATTR {
            if (!kFusesExactly) return;
            done = intersect_together(
                id, lanes,
                [&](const RayLanes& rays, std::uint32_t wanted, GroupHits& hits) HWY_ATTR {
                    LaneCrossings found;
                    find_first_crossings(rays, shape.frustum, shape.capped, wanted, found);
                    hits.set(found);
                },
                stats);
        };
        if (is_bare<Cylinder>(*scene_.table, id)) {
            const auto& cylinder = shape_of<Cylinder>(*scene_.table, id);
            meet(cylinder);
            return done | intersect_first(id, cylinder, lanes, stats);
        }
        if (is_bare<Cone>(*scene_.table, id)) meet(shape_of<Cone>(*scene_.table, id));
        return done | intersect_alone(id, lanes, stats);
    }
    template <class Stats>
    HWY_NOINLINE std::uint32_t intersect_other(PrimitiveId id, std::uint32_t lanes, Stats stats) {
        if (!is_bare<Polygon>(*scene_.table, id)) return intersect_alone(id, lanes, stats);
        const auto& polygon = shape_of<Polygon>(*scene_.table, id);
        const std::uint32_t done = intersect_together(
            id, lanes,
            [&](const RayLanes& rays, std::uint32_t wanted, GroupHits& hits) {
                hits.hit = first_hits(polygon, rays, wanted, hits.of_ray);
            },
            stats);
        return done | intersect_first(id, polygon, lanes, stats);
    }
    /// The groups of which several rays may meet a shape; leaves all other rays in `lanes`.
    template <class Test, class Stats>
    HWY_INLINE std::uint32_t intersect_together(PrimitiveId id, std::uint32_t& lanes, Test&& test,
                                                Stats stats) {
        std::uint32_t done = 0;
        for (std::size_t g = 0; g < kLaneGroups; ++g) {
            const std::uint32_t here = lanes >> (g * kRayLanes) & kAllRayLanes;
            if (std::popcount(here) < kLeastTogether) continue;
            packet_.lay_out(g, rays_);
            GroupHits hits;
            test(packet_.rays[g], here, hits);
            const std::uint32_t decided = here & ~hits.unsure;
            stats.primitives(static_cast<std::uint64_t>(std::popcount(decided)));
            stats.primitive_hits(static_cast<std::uint64_t>(std::popcount(hits.hit)));
            for_each_lane(hits.hit, [&](std::size_t lane) HWY_ATTR {
                const std::size_t i = g * kRayLanes + lane;
                float s_max = std::numeric_limits<float>::infinity();
                if (derived().accept(i, id, hits.of_ray[lane], s_max)) done |= 1u << i;
            });
            lanes &= ~(decided << (g * kRayLanes));
        }
        return done;
    }
    /// The i-th ray; `scratch` may hold it.
    [[nodiscard]] HWY_INLINE const Ray& ray_of(std::size_t i, Ray& scratch) {
        if (rays_.columns() == nullptr) return rays_.ray(i, scratch);
        packet_.lay_out(i / kRayLanes, rays_);
        scratch = packet_.rays[i / kRayLanes].ray(i % kRayLanes);
        return scratch;
    }

    const WideBvhScene& scene_;
    GivenRays rays_;
    LanePacket& packet_;

  private:
    /// Fewer rays are as fast one by one.
    static constexpr int kLeastTogether = 3;
    /// Where a block has this many rays for each shape, or more, each shape is tested against all
    /// rays at once: for closest hits, tests in double are as well.
    static constexpr int kRaysPerShape = Derived::kOrdered ? 1 : 2;
};

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#endif  // include guard that opens again for every target
