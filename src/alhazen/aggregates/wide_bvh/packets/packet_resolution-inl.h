/// Exact resolution of the candidates of a packet: the rays of a group, which are in lanes, each
/// with its own triangle, for most rays the same.
///
/// Conventions: included once per target (see simd/lanes-inl.h).

#if defined(ALHAZEN_AGGREGATES_WIDE_BVH_PACKETS_PACKET_RESOLUTION_INL_H_) == \
    defined(HWY_TARGET_TOGGLE)
#ifdef ALHAZEN_AGGREGATES_WIDE_BVH_PACKETS_PACKET_RESOLUTION_INL_H_
#undef ALHAZEN_AGGREGATES_WIDE_BVH_PACKETS_PACKET_RESOLUTION_INL_H_
#else
#define ALHAZEN_AGGREGATES_WIDE_BVH_PACKETS_PACKET_RESOLUTION_INL_H_
#endif

#include <hwy/cache_control.h>

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
    using Ids = Lanes<float, kRays>;                 ///< bits of PrimitiveId
    using LocalCorners = Lanes<float, kRays>[3][3];  ///< [corner][axis], in the local frame
    /// Whether a register holds a row of a block.
    static constexpr bool kHoldsRow = HWY_TARGET != HWY_SCALAR && kParts<float, kRays> == 1;

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
        const TrianglePlace first = places[std::countr_zero(lanes)];
        if ((lanes & ~lanes_with(places, first)) == 0) return take_one(first, corners, ids);
        LocalCorners local = {};
        ids = Ids(0.0f);
        if constexpr (kHoldsRow) {
            if (!take_rows(lanes, places, axes, local, ids)) return false;
        } else {
            if (!take_one_by_one(lanes, places, axes, local, ids)) return false;
        }
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
    /// The same of one triangle, for all lanes.
    HWY_INLINE bool take_one(TrianglePlace place, Corners& corners, Ids& ids) const {
        const TriangleBlock& block = scene_.layout->triangles[place / kBlockWidth];
        const std::size_t lane = place % kBlockWidth;
        if (!block.ids[lane].exact()) return false;
        ids = bits_as_lanes(block.ids[lane].id());
        const std::size_t axes[3] = {packet_.kx, packet_.ky, packet_.kz};
        const LocalFrame& frame = scene_.layout->frame;
        HWY_UNROLL(3)
        for (std::size_t k = 0; k < 3; ++k) {
            const double center = (&frame.center.x)[axes[k]];
            HWY_UNROLL(3)
            for (std::size_t i = 0; i < 3; ++i) {
                const auto local = static_cast<double>(block.vertex[i][axes[k]][lane]);
                corners[i][k] = Reals(frame.inverse_scale * local + center);
            }
        }
        return true;
    }
    /// Triangle by triangle.
    HWY_INLINE bool take_one_by_one(std::uint32_t lanes, const TrianglePlace* places,
                                    const std::size_t (&axes)[3], LocalCorners& local,
                                    Ids& ids) const {
        return for_each_place(lanes, places, [&](TrianglePlace place, std::uint32_t same) HWY_ATTR {
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
                        select_lanes(mask, Ids(block.vertex[i][axes[k]][lane]), local[i][k]);
                }
            }
            return true;
        });
    }
    /// Block by block: a row of eight triangles is permuted into the lanes.
    HWY_INLINE bool take_rows(std::uint32_t lanes, const TrianglePlace* places,
                              const std::size_t (&axes)[3], LocalCorners& local, Ids& ids) const {
#if HWY_TARGET != HWY_SCALAR  // the scalar target has nothing to permute
        const LaneTag<float, kRays> d;
        const hn::RebindToUnsigned<decltype(d)> du;
        static_assert(kBlockWidth == 8);
        const auto place = hn::LoadU(du, places);
        const auto number = hn::ShiftRight<3>(place);
        const auto lane = hn::IndicesFromVec(d, hn::And(place, hn::Set(du, kBlockWidth - 1)));
        std::uint32_t others = ((1u << kRays) - 1) & ~lanes;
        for (std::uint32_t rest = lanes; rest != 0;) {
            const TrianglePlace first = places[std::countr_zero(rest)] / kBlockWidth;
            const TriangleBlock& block = scene_.layout->triangles[first];
            LaneMask<TrianglePlace, kRays> in_block;
            in_block.part[0] = hn::Eq(number, hn::Set(du, first));
            const std::uint32_t same = rest & bits_of(in_block);
            rest &= ~same;
            const auto mask = lanes_of_bits<float, kRays>(same | others).part[0];
            others = 0;
            const auto take = [&](const float* row, Ids& to) HWY_ATTR {
                to.part[0] =
                    hn::IfThenElse(mask, hn::TableLookupLanes(row_of_block(row), lane), to.part[0]);
            };
            take(reinterpret_cast<const float*>(block.ids), ids);
            HWY_UNROLL(3)
            for (std::size_t i = 0; i < 3; ++i) {
                HWY_UNROLL(3)
                for (std::size_t k = 0; k < 3; ++k) take(block.vertex[i][axes[k]], local[i][k]);
            }
        }
        const auto bits = hn::BitCast(du, ids.part[0]);
        LaneMask<TrianglePlace, kRays> exact;
        exact.part[0] = hn::TestBit(bits, hn::Set(du, BlockId::kExactBit));
        if (HWY_UNLIKELY((lanes & ~bits_of(exact)) != 0)) return false;
        ids.part[0] = hn::BitCast(d, hn::And(bits, hn::Set(du, BlockId::kLimit)));
#endif
        return true;
    }
    /// A row of a block in the first lanes.
    static HWY_INLINE hn::Vec<LaneTag<float, kRays>> row_of_block(const float* row) {
        const LaneTag<float, kBlockWidth> d;
#if HWY_CAP_GE512
        if constexpr (kRays > kBlockWidth) {
            return hn::ZeroExtendVector(LaneTag<float, kRays>(), hn::Load(d, row));
        }
#endif
        if constexpr (kRays == kBlockWidth) return hn::Load(d, row);
    }
    /// Corners from the mesh where the block holds rounded ones.
    HWY_INLINE void take_corners(std::uint32_t lanes, const TrianglePlace* places, Corners& corners,
                                 Ids& ids) const {
        const std::size_t axes[3] = {packet_.kx, packet_.ky, packet_.kz};
        ids = Ids(0.0f);
        for (auto& corner : corners) {
            for (Reals& along : corner) along = Reals(0.0);
        }
        // All are found before the first is read, so that they come from memory together.
        struct Found {
            const std::array<std::uint32_t, 3>* indices = nullptr;
            const Vec3* positions = nullptr;  ///< null: the block holds the corners
            TrianglePlace place;
            std::uint32_t lanes;
        };
        Found found[kRays];
        std::size_t count = 0;
        (void)for_each_place(lanes, places, [&](TrianglePlace place, std::uint32_t same) HWY_ATTR {
            Found& here = found[count++];
            here.place = place;
            here.lanes = same;
            if (id(place).exact()) return true;
            const std::uint32_t number = triangle(place);
            const PlacedMesh& mesh = scene_.table->mesh_of(number);
            here.indices = &mesh.mesh->triangles[number - mesh.first_triangle];
            here.positions = mesh.mesh->positions.data();
            for (const std::uint32_t i : *here.indices) {
                hwy::Prefetch(&here.positions[i].x);
                hwy::Prefetch(&here.positions[i].z);
            }
            return true;
        });
        for (std::size_t n = 0; n < count; ++n) {
            const Found& here = found[n];
            const BlockId triangle_id = id(here.place);
            ids = select_lanes(lanes_of_bits<float, kRays>(here.lanes),
                               bits_as_lanes(triangle_id.id()), ids);
            const auto mask = lanes_of_bits<double, kRays>(here.lanes);
            HWY_UNROLL(3)
            for (std::size_t i = 0; i < 3; ++i) {
                Vec3 exact;
                const Vec3* corner = &exact;
                if (here.positions != nullptr) {
                    corner = &here.positions[(*here.indices)[i]];
                } else {
                    const TriangleBlock& block = scene_.layout->triangles[here.place / kBlockWidth];
                    exact = scene_.layout->frame.world(block.corner(i, here.place % kBlockWidth));
                }
                HWY_UNROLL(3)
                for (std::size_t k = 0; k < 3; ++k) {
                    corners[i][k] = select_lanes(mask, Reals((&corner->x)[axes[k]]), corners[i][k]);
                }
            }
        }
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
