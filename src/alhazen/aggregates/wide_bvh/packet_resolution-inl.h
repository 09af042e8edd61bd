/// Exact resolution of the candidates of a packet: the rays of a group, which are in lanes, each
/// with its own triangle, for most rays the same.
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

#include "alhazen/accel/wide_bvh/trace/given_rays-inl.h"
#include "alhazen/accel/wide_bvh/trace/packet-inl.h"
#include "alhazen/aggregates/wide_bvh/exact_resolution-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {

/// Position of a triangle in the leaves: 8 times the number of its block, plus the lane.
using TrianglePlace = std::uint32_t;

/// `Packet` has rays in groups of eight, `kResolvedGroups` of which are resolved together, and the
/// axes of its rays as in RayShear.
template <class Packet>
class PacketResolution {
  public:
    static constexpr std::size_t kRays = Packet::kResolvedGroups * kGroupRays;  ///< together

    HWY_INLINE PacketResolution(const WideBvhScene& scene, const Packet& packet,
                                const GivenRays& rays)
        : scene_(scene), packet_(packet), rays_(rays) {}

    /// Tests rays of the `n`-th kRays, each with the triangle at `places[lane]`; calls `hits(ray,
    /// id, shape_hit)` for those that hit, or `hits.take(n, lanes, ids, verdicts)` for several.
    template <class Hits, class Stats>
    HWY_NOINLINE HWY_FLATTEN void resolve(std::size_t n, std::uint32_t lanes,
                                          const TrianglePlace* places, Hits&& hits, Stats stats) {
        PairLanes<kRays> pairs;
        Ids ids;
        if (HWY_UNLIKELY(!take_corners_of_blocks(lanes, places, pairs.vertex, ids))) {
            take_corners(lanes, places, pairs.vertex, ids);
        }
        take_rays(&packet_.rays[n * Packet::kResolvedGroups], pairs);
        const Reals z = abs(pairs.direction[2]);
        const std::uint32_t set_up =
            bits_of((z > abs(pairs.direction[0])) & (z > abs(pairs.direction[1])));
        PairVerdicts<kRays> verdicts;
        verdicts.test(pairs);
        const std::uint32_t alone = (verdicts.unsure | ~set_up) & lanes;
        const std::uint32_t decided = verdicts.hit & lanes & ~alone;
        stats.primitive_hits(static_cast<std::uint64_t>(std::popcount(decided)));
        if constexpr (requires { hits.take(n, decided, ids, verdicts); }) {
            hits.take(n, decided, ids, verdicts);
        } else {
            for (std::uint32_t rest = decided; rest != 0; rest &= rest - 1) {
                const auto lane = static_cast<std::size_t>(std::countr_zero(rest));
                hits(n * kRays + lane, id(places[lane]).id(),
                     ShapeHit{verdicts.t[lane], verdicts.u[lane], verdicts.v[lane], 0});
            }
        }
        for (std::uint32_t rest = alone; HWY_UNLIKELY(rest != 0); rest &= rest - 1) {
            const auto lane = static_cast<std::size_t>(std::countr_zero(rest));
            ShapeHit hit;
            if (!resolve_scalar(n * kRays + lane, places[lane], hit)) continue;
            stats.primitive_hits(1);
            hits(n * kRays + lane, id(places[lane]).id(), hit);
        }
    }

  private:
    using Reals = Lanes<double, kRays>;
    using Corners = Reals[3][3];
    using Ids = Lanes<float, kRays>;  ///< bits of PrimitiveId

    HWY_INLINE void take_rays(const RayLanes* groups, PairLanes<kRays>& pairs) const {
        const auto row = [&](const auto& of) HWY_ATTR {
            const LaneTag<double, kRays> d;
            constexpr std::size_t kEach = kParts<double, kRays> / Packet::kResolvedGroups;
            Reals r;
            for (std::size_t g = 0; g < Packet::kResolvedGroups; ++g) {
                const double* lanes = of(groups[g]);
                for (std::size_t i = 0; i < kEach; ++i) {
                    r.part[g * kEach + i] = hn::Load(d, lanes + i * hn::Lanes(d));
                }
            }
            return r;
        };
        const std::size_t axes[3] = {packet_.kx, packet_.ky, packet_.kz};
        HWY_UNROLL(3)
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t axis = axes[k];
            pairs.origin[k] = row([axis](const RayLanes& g) { return g.origin[axis]; });
            pairs.direction[k] = row([axis](const RayLanes& g) { return g.direction[axis]; });
        }
        pairs.t_min = row([](const RayLanes& g) { return g.t_min; });
        pairs.t_max = row([](const RayLanes& g) { return g.t_max; });
    }
    [[nodiscard]] HWY_INLINE BlockId id(TrianglePlace place) const {
        return scene_.layout->triangles[place / kBlockWidth].ids[place % kBlockWidth];
    }
    [[nodiscard]] std::uint32_t triangle(TrianglePlace place) const {
        return static_cast<std::uint32_t>(id(place).id()) - scene_.table->first(kTriangleKind);
    }

    static HWY_INLINE Ids bits_as_lanes(PrimitiveId id) {
        return Ids(std::bit_cast<float>(static_cast<std::uint32_t>(id)));
    }
    static HWY_INLINE std::uint32_t lanes_with(const TrianglePlace* places, TrianglePlace place) {
        const LaneTag<TrianglePlace, kRays> d;
        LaneMask<TrianglePlace, kRays> same;
        for (std::size_t i = 0; i < kParts<TrianglePlace, kRays>; ++i) {
            same.part[i] = hn::Eq(hn::LoadU(d, places + i * hn::Lanes(d)), hn::Set(d, place));
        }
        return bits_of(same);
    }

    /// Calls `take(place, same)` for each triangle of `lanes` with the lanes that have it; the
    /// first call includes the lanes outside of `lanes`. False if `take` returned false.
    template <class Take>
    static HWY_INLINE bool for_each_place(std::uint32_t lanes, const TrianglePlace* places,
                                          Take&& take) {
        std::uint32_t others = ((1u << kRays) - 1) & ~lanes;
        for (std::uint32_t rest = lanes; rest != 0;) {
            const TrianglePlace place = places[std::countr_zero(rest)];
            const std::uint32_t same = rest & lanes_with(places, place);
            rest &= ~same;
            if (!take(place, same | others)) return false;
            others = 0;
        }
        return true;
    }
    /// The corners of blocks that float holds exactly, as LocalFrame::world; false if one is not
    /// exact.
    HWY_INLINE bool take_corners_of_blocks(std::uint32_t lanes, const TrianglePlace* places,
                                           Corners& corners, Ids& ids) const {
        const std::size_t axes[3] = {packet_.kx, packet_.ky, packet_.kz};
        using F = Lanes<float, kRays>;
        F local[3][3] = {};
        ids = F(0.0f);
        const bool taken =
            for_each_place(lanes, places, [&](TrianglePlace place, std::uint32_t same) HWY_ATTR {
                const TriangleBlock& block = scene_.layout->triangles[place / kBlockWidth];
                const std::size_t lane = place % kBlockWidth;
                if (!block.ids[lane].exact()) return false;
                const auto mask = lanes_of_bits<float, kRays>(same);
                ids = select_lanes(mask, bits_as_lanes(block.ids[lane].id()), ids);
                HWY_UNROLL(3)
                for (std::size_t i = 0; i < 3; ++i) {
                    HWY_UNROLL(3)
                    for (std::size_t k = 0; k < 3; ++k) {
                        local[i][k] =
                            select_lanes(mask, F(block.vertex[i][axes[k]][lane]), local[i][k]);
                    }
                }
                return true;
            });
        if (!taken) return false;
        const LocalFrame& frame = scene_.layout->frame;
        HWY_UNROLL(3)
        for (std::size_t k = 0; k < 3; ++k) {
            const Reals center((&frame.center.x)[axes[k]]);
            HWY_UNROLL(3)
            for (std::size_t i = 0; i < 3; ++i) {
                corners[i][k] = Reals(frame.inverse_scale) * as_doubles(local[i][k]) + center;
            }
        }
        return true;
    }
    /// Corners from the mesh where the block holds rounded ones.
    HWY_INLINE void take_corners(std::uint32_t lanes, const TrianglePlace* places, Corners& corners,
                                 Ids& ids) const {
        const std::size_t axes[3] = {packet_.kx, packet_.ky, packet_.kz};
        ids = Ids(0.0f);
        (void)for_each_place(lanes, places, [&](TrianglePlace place, std::uint32_t same) HWY_ATTR {
            Vec3 exact[3];
            std::array<const Vec3*, 3> from{&exact[0], &exact[1], &exact[2]};
            if (id(place).exact()) {
                const TriangleBlock& block = scene_.layout->triangles[place / kBlockWidth];
                for (std::size_t i = 0; i < 3; ++i) {
                    exact[i] = scene_.layout->frame.world(block.corner(i, place % kBlockWidth));
                }
            } else {
                from = scene_.table->corner_positions(triangle(place));
            }
            ids =
                select_lanes(lanes_of_bits<float, kRays>(same), bits_as_lanes(id(place).id()), ids);
            const auto mask = lanes_of_bits<double, kRays>(same);
            HWY_UNROLL(3)
            for (std::size_t i = 0; i < 3; ++i) {
                HWY_UNROLL(3)
                for (std::size_t k = 0; k < 3; ++k) {
                    corners[i][k] =
                        select_lanes(mask, Reals((&from[i]->x)[axes[k]]), corners[i][k]);
                }
            }
            return true;
        });
    }
    HWY_NOINLINE bool resolve_scalar(std::size_t ray, TrianglePlace place, ShapeHit& hit) const {
        const auto [a, b, c] = scene_.table->triangle_vertices(triangle(place));
        Ray scratch;
        const Ray& given = rays_.ray(ray, scratch);
        return intersect_triangle(given, RayShear(given.direction), a, b, c, hit);
    }

    const WideBvhScene& scene_;
    const Packet& packet_;
    GivenRays rays_;
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
