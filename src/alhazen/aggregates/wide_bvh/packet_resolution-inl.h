/// Exact resolution of the candidates of a packet, eight pairs of a ray and a triangle at a time,
/// by TrianglePairs.
///
/// Conventions: included once per target (see simd/lanes-inl.h).

#if defined(ALHAZEN_AGGREGATES_WIDE_BVH_PACKET_RESOLUTION_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ALHAZEN_AGGREGATES_WIDE_BVH_PACKET_RESOLUTION_INL_H_
#undef ALHAZEN_AGGREGATES_WIDE_BVH_PACKET_RESOLUTION_INL_H_
#else
#define ALHAZEN_AGGREGATES_WIDE_BVH_PACKET_RESOLUTION_INL_H_
#endif

#include <bit>
#include <span>

#include "alhazen/accel/wide_bvh/trace/packet-inl.h"
#include "alhazen/aggregates/wide_bvh/exact_resolution-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {

/// Position of a triangle in the leaves: 8 times the number of its block, plus the lane.
using TrianglePlace = std::uint32_t;

class PacketResolution {
  public:
    HWY_INLINE PacketResolution(const WideBvhScene& scene, const RayPacket& packet,
                                std::span<const Ray> rays)
        : scene_(scene), packet_(packet), rays_(rays) {}

    /// Adds a pair; calls `hits(ray, id, shape_hit)` for those that hit, at once or later.
    template <class Hits, class Stats>
    HWY_INLINE void add(std::size_t ray, TrianglePlace place, Hits&& hits, Stats stats) {
        ray_[count_] = static_cast<std::uint32_t>(ray);
        place_[count_] = place;
        if (++count_ == kLaneCount) resolve(hits, stats);
    }
    template <class Hits, class Stats>
    HWY_NOINLINE void resolve(Hits&& hits, Stats stats) {
        if (count_ == 0) return;
        // Free lanes repeat the first.
        for (std::size_t i = count_; i < kLaneCount; ++i) {
            ray_[i] = ray_[0];
            place_[i] = place_[0];
        }
        const std::uint32_t set_up = fill();
        pairs_.resolve((1u << count_) - 1, set_up,
                       [&](std::size_t lane, ShapeHit& hit)
                           HWY_ATTR { return resolve_scalar(lane, hit); },
                       [&](std::size_t lane, const ShapeHit& hit) HWY_ATTR {
                           stats.primitive_hits(1);
                           hits(ray_[lane], id(lane).id(), hit);
                           return false;
                       });
        count_ = 0;
    }

  private:
    [[nodiscard]] HWY_INLINE BlockId id(std::size_t lane) const {
        return scene_.layout->triangles[place_[lane] / kBlockWidth].ids[place_[lane] % kBlockWidth];
    }

    /// Bits of the lanes with the main axis of the packet.
    HWY_INLINE std::uint32_t fill() {
        const std::size_t axes[3] = {packet_.kx, packet_.ky, packet_.kz};
        for (std::size_t i = 0; i < kLaneCount; ++i) {
            const RayLanes& rays = packet_.rays[ray_[i] / kGroupRays];
            const std::size_t lane = ray_[i] % kGroupRays;
            HWY_UNROLL(3)
            for (std::size_t k = 0; k < 3; ++k) {
                pairs_.origin[k][i] = rays.origin[axes[k]][lane];
                pairs_.direction[k][i] = rays.direction[axes[k]][lane];
            }
            pairs_.t_min[i] = rays.t_min[lane];
            pairs_.t_max[i] = rays.t_max[lane];
        }
        gather_corners();
        for (std::size_t i = 0; i < kLaneCount; ++i) {
            if (HWY_UNLIKELY(!id(i).exact())) fetch_corners(i);
        }
        const Doubles z = abs(load_lanes(pairs_.direction[2]));
        return bits_of((z > abs(load_lanes(pairs_.direction[0]))) &
                       (z > abs(load_lanes(pairs_.direction[1]))));
    }
    HWY_INLINE void gather_corners() {
        const LocalFrame& frame = scene_.layout->frame;
        const double center[3] = {frame.center.x, frame.center.y, frame.center.z};
        const std::size_t axes[3] = {packet_.kx, packet_.ky, packet_.kz};
        // One by one: gathers are slower on processors with the microcode mitigation.
        HWY_ALIGN float x[3][3][kLaneCount];
        for (std::size_t i = 0; i < kLaneCount; ++i) {
            const TriangleBlock& block = scene_.layout->triangles[place_[i] / kBlockWidth];
            const std::size_t lane = place_[i] % kBlockWidth;
            HWY_UNROLL(3)
            for (std::size_t k = 0; k < 3; ++k) {
                for (std::size_t c = 0; c < 3; ++c) x[c][k][i] = block.vertex[c][axes[k]][lane];
            }
        }
        for (std::size_t c = 0; c < 3; ++c) {
            for (std::size_t k = 0; k < 3; ++k) {
                store_lanes(
                    Doubles(frame.inverse_scale) * as_doubles(x[c][k]) + Doubles(center[axes[k]]),
                    pairs_.vertex[c][k]);
            }
        }
    }
    static HWY_INLINE Doubles as_doubles(const float (&x)[kLaneCount]) {
        const LaneTag<double> d;
        const hn::Rebind<float, LaneTag<double>> df;
        Doubles r;
        ALHAZEN_UNROLL
        for (std::size_t i = 0; i < kParts<double>; ++i) {
            r.part[i] = hn::PromoteTo(d, hn::Load(df, x + i * hn::Lanes(d)));
        }
        return r;
    }
    [[nodiscard]] std::uint32_t triangle(std::size_t lane) const {
        return static_cast<std::uint32_t>(id(lane).id()) - scene_.table->first(kTriangleKind);
    }
    /// From the mesh: in the block they are rounded.
    HWY_NOINLINE void fetch_corners(std::size_t lane) {
        const auto [a, b, c] = scene_.table->triangle_vertices(triangle(lane));
        const std::uint32_t axes[3] = {packet_.kx, packet_.ky, packet_.kz};
        for (std::size_t k = 0; k < 3; ++k) {
            const auto axis = static_cast<int>(axes[k]);
            pairs_.vertex[0][k][lane] = a[axis];
            pairs_.vertex[1][k][lane] = b[axis];
            pairs_.vertex[2][k][lane] = c[axis];
        }
    }
    HWY_NOINLINE bool resolve_scalar(std::size_t lane, ShapeHit& hit) const {
        const auto [a, b, c] = scene_.table->triangle_vertices(triangle(lane));
        const Ray& ray = rays_[ray_[lane]];
        return intersect_triangle(ray, RayShear(ray.direction), a, b, c, hit);
    }

    const WideBvhScene& scene_;
    const RayPacket& packet_;
    std::span<const Ray> rays_;
    std::size_t count_ = 0;
    std::uint32_t ray_[kLaneCount];
    TrianglePlace place_[kLaneCount];
    TrianglePairs pairs_;
};

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#endif  // include guard that opens again for every target
