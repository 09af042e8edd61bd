/// Exact resolution of the candidates of a packet: the rays of a group, which are in lanes already,
/// each with a triangle of its own. Most of them have the same.
///
/// Conventions: included once per target (see simd/lanes-inl.h).

#if defined(ALHAZEN_AGGREGATES_WIDE_BVH_PACKET_RESOLUTION_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ALHAZEN_AGGREGATES_WIDE_BVH_PACKET_RESOLUTION_INL_H_
#undef ALHAZEN_AGGREGATES_WIDE_BVH_PACKET_RESOLUTION_INL_H_
#else
#define ALHAZEN_AGGREGATES_WIDE_BVH_PACKET_RESOLUTION_INL_H_
#endif

#include <array>
#include <bit>
#include <span>

#include "alhazen/accel/wide_bvh/trace/packet-inl.h"
#include "alhazen/aggregates/wide_bvh/exact_resolution-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {

/// Position of a triangle in the leaves: 8 times the number of its block, plus the lane.
using TrianglePlace = std::uint32_t;

/// `Packet` has the rays in groups of eight, and the axes of its rays as in RayShear.
template <class Packet>
class PacketResolution {
  public:
    HWY_INLINE PacketResolution(const WideBvhScene& scene, const Packet& packet,
                                std::span<const Ray> rays)
        : scene_(scene), packet_(packet), rays_(rays) {}

    /// Tests rays of group `g`, each with the triangle at `places[lane]`; calls `hits(ray, id,
    /// shape_hit)` for those that hit.
    template <class Hits, class Stats>
    HWY_NOINLINE void resolve(std::size_t g, std::uint32_t lanes, const TrianglePlace* places,
                              Hits&& hits, Stats stats) {
        bool first = true;
        for (std::uint32_t rest = lanes; rest != 0; first = false) {
            const TrianglePlace place = places[std::countr_zero(rest)];
            const std::uint32_t same = rest & lanes_with(places, place);
            set_corners(place, first ? kAllLanes : same);
            rest &= ~same;
        }
        const RayLanes& rays = packet_.rays[g];
        const std::size_t axes[3] = {packet_.kx, packet_.ky, packet_.kz};
        PairRows rows;
        HWY_UNROLL(3)
        for (std::size_t k = 0; k < 3; ++k) {
            for (std::size_t i = 0; i < 3; ++i) rows.vertex[i][k] = vertex_[i][axes[k]];
            rows.origin[k] = rays.origin[axes[k]];
            rows.direction[k] = rays.direction[axes[k]];
        }
        rows.t_min = rays.t_min;
        rows.t_max = rays.t_max;
        const Doubles z = abs(load_lanes(rows.direction[2]));
        const std::uint32_t set_up = bits_of((z > abs(load_lanes(rows.direction[0]))) &
                                             (z > abs(load_lanes(rows.direction[1]))));
        PairVerdicts verdicts;
        verdicts.test(rows);
        verdicts.take(
            lanes, set_up,
            [&](std::size_t lane, ShapeHit& hit)
                HWY_ATTR { return resolve_scalar(g * kGroupRays + lane, places[lane], hit); },
            [&](std::size_t lane, const ShapeHit& hit) HWY_ATTR {
                stats.primitive_hits(1);
                hits(g * kGroupRays + lane, id(places[lane]).id(), hit);
                return false;
            });
    }

  private:
    [[nodiscard]] HWY_INLINE BlockId id(TrianglePlace place) const {
        return scene_.layout->triangles[place / kBlockWidth].ids[place % kBlockWidth];
    }
    [[nodiscard]] std::uint32_t triangle(TrianglePlace place) const {
        return static_cast<std::uint32_t>(id(place).id()) - scene_.table->first(kTriangleKind);
    }

    static HWY_INLINE std::uint32_t lanes_with(const TrianglePlace* places, TrianglePlace place) {
        const LaneTag<TrianglePlace> d;
        LaneMask<TrianglePlace> same;
        for (std::size_t i = 0; i < kParts<TrianglePlace>; ++i) {
            same.part[i] = hn::Eq(hn::LoadU(d, places + i * hn::Lanes(d)), hn::Set(d, place));
        }
        return bits_of(same);
    }

    /// In all lanes or in some.
    HWY_INLINE void set_corners(TrianglePlace place, std::uint32_t lanes) {
        if (HWY_LIKELY(!id(place).exact())) {
            // From the mesh: in the block they are rounded.
            return set_corners(scene_.table->corner_positions(triangle(place)), lanes);
        }
        const LocalFrame& frame = scene_.layout->frame;
        const TriangleBlock& block = scene_.layout->triangles[place / kBlockWidth];
        Vec3 corner[3];
        for (std::size_t i = 0; i < 3; ++i) {
            corner[i] = frame.world(block.corner(i, place % kBlockWidth));
        }
        set_corners({&corner[0], &corner[1], &corner[2]}, lanes);
    }
    HWY_INLINE void set_corners(const std::array<const Vec3*, 3>& corners, std::uint32_t lanes) {
        HWY_UNROLL(3)
        for (std::size_t i = 0; i < 3; ++i) {
            const Vec3& p = *corners[i];
            if (lanes == kAllLanes) {
                store_lanes(Doubles(p.x), vertex_[i][0]);
                store_lanes(Doubles(p.y), vertex_[i][1]);
                store_lanes(Doubles(p.z), vertex_[i][2]);
                continue;
            }
            for (std::uint32_t rest = lanes; rest != 0; rest &= rest - 1) {
                const auto lane = static_cast<std::size_t>(std::countr_zero(rest));
                vertex_[i][0][lane] = p.x;
                vertex_[i][1][lane] = p.y;
                vertex_[i][2][lane] = p.z;
            }
        }
    }
    HWY_NOINLINE bool resolve_scalar(std::size_t ray, TrianglePlace place, ShapeHit& hit) const {
        const auto [a, b, c] = scene_.table->triangle_vertices(triangle(place));
        return intersect_triangle(rays_[ray], RayShear(rays_[ray].direction), a, b, c, hit);
    }

    const WideBvhScene& scene_;
    const Packet& packet_;
    std::span<const Ray> rays_;
    alignas(64) double vertex_[3][3][kLaneCount];  ///< [corner][axis][lane], axes of the scene
};

/// Offers the hits of PacketResolution to the closest ones.
struct OfferedHits {
    std::span<Hit> best;
    void operator()(std::size_t i, PrimitiveId id, const ShapeHit& hit) const {
        Ray ray;
        offer_hit(hit, id, ray, best[i]);
    }
};

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#endif  // include guard that opens again for every target
