#include "alhazen/aggregates/wide_bvh/treeless_packets.h"

#include <algorithm>
#include <array>
#include <bit>

#include "alhazen/aggregates/wide_bvh/schedule.h"
#include "alhazen/geometry/ray_lanes.h"
#include "alhazen/primitives/primitive_columns.h"
#include "alhazen/shapes/core/first_hits.h"

namespace alhazen {

namespace {

constexpr std::size_t kBlock = 32;  ///< number of rays of a block, which a set holds as bits
static_assert(kMostPatchRays <= kBlock && kMaxPacketRays <= kBlock);

/// Some rays of a batch: references to them or, where they differ, copies.
class RayBlock {
  public:
    [[nodiscard]] std::size_t size() const { return count_; }
    void clear() { count_ = 0; }
    void add(const Ray& ray, std::size_t number) {
        rays_[count_] = &ray;
        numbers_[count_++] = number;
    }
    /// The index in the batch of the i-th ray.
    [[nodiscard]] std::size_t number(std::size_t i) const { return numbers_[i]; }
    /// The rays in the frame of a shape.
    [[nodiscard]] std::span<const Ray* const> in_frame(const Affine* inner_from_outer,
                                                       std::span<const Hit> best) {
        for (std::size_t i = 0; i < count_; ++i) {
            const bool shorter = !best.empty() && best[numbers_[i]].found();
            used_[i] = rays_[i];
            if (!shorter && inner_from_outer == nullptr) continue;
            own_[i] =
                inner_from_outer != nullptr ? transformed(*inner_from_outer, *rays_[i]) : *rays_[i];
            if (shorter) own_[i].t_max = best[numbers_[i]].t;
            used_[i] = &own_[i];
        }
        return std::span(used_).first(count_);
    }

  private:
    std::size_t count_ = 0;
    std::array<const Ray*, kBlock> rays_, used_;
    std::array<std::size_t, kBlock> numbers_;
    std::array<Ray, kBlock> own_;
};

/// The rays of a block that hit the shape; `best` as for `in_frame`.
std::uint32_t test_block(const PrimitiveTable& table, PrimitiveId id, RayBlock& block,
                         std::span<const Hit> best, ShapeHit* hits, TraversalStats* stats) {
    const std::uint32_t kind = table.kind(id);
    const std::uint32_t i = static_cast<std::uint32_t>(id) - table.first(kind);
    const std::uint32_t found = with_column(table.columns, kind, [&](const auto& c) {
        using S = typename ShapeOfColumn<decltype(c)>::Type;
        if constexpr (HasPacketTest<S>) {
            const std::uint32_t placement = c.placements[i];
            const Affine* inner_from_outer = nullptr;
            if (placement != kNoPlacement) {
                inner_from_outer = &table.placements[placement].inner_from_outer;
            }
            const auto rays = block.in_frame(inner_from_outer, best);
            std::uint32_t set = 0;
            for (std::size_t k = 0; k < rays.size(); k += kMostRaysAtOnce<S>) {
                const auto some = rays.subspan(k, std::min(kMostRaysAtOnce<S>, rays.size() - k));
                set |= first_hits(c.shapes[i], some, hits + k) << k;
            }
            return set;
        } else {
            return std::uint32_t{0};  // kinds without a packet test are never listed
        }
    });
    if (stats != nullptr) {
        stats->primitive_tests += block.size();
        stats->primitive_hits += static_cast<std::uint64_t>(std::popcount(found));
    }
    return found;
}

/// Calls f(block) for all valid rays that are not `done`.
template <class Done, class F>
void for_each_block(std::span<const Ray> rays, Done&& done, F&& f) {
    RayBlock block;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        if (!done(i) && is_valid(rays[i])) block.add(rays[i], i);
        if (block.size() < kBlock && i + 1 < rays.size()) continue;
        if (block.size() > 0) f(block);
        block.clear();
    }
}

}  // namespace

TreelessPackets::TreelessPackets(const PrimitiveTable& table,
                                 std::span<const PrimitiveId> outside) {
    if (table.size() == outside.size() || table.size() - outside.size() > kMaxTreelessPrimitives)
        return;
    for (std::uint32_t i = 0; i < table.size(); ++i) {
        const PrimitiveId id{i};
        if (std::find(outside.begin(), outside.end(), id) != outside.end()) continue;
        const std::uint32_t kind = table.kind(id);
        const bool fits = kind < kTriangleKind && with_column(table.columns, kind, [](auto& c) {
                              using S = typename ShapeOfColumn<decltype(c)>::Type;
                              return HasPacketTest<S>;
                          });
        if (!fits) {
            ids_.clear();
            return;
        }
        ids_.push_back(id);
    }
}

void TreelessPackets::closest(const PrimitiveTable& table, std::span<const Ray> rays,
                              std::span<Hit> best, RayQuery query) const {
    const auto done = [](std::size_t) { return false; };
    for_each_block(rays, done, [&](RayBlock& block) {
        for (const PrimitiveId id : ids_) {
            if (!table.is_seen(id, query.mask)) continue;
            std::array<ShapeHit, kBlock> hits;
            for_each_lane(test_block(table, id, block, best, hits.data(), query.stats),
                          [&](std::size_t lane) {
                              Ray shrinking;
                              offer_hit(hits[lane], id, shrinking, best[block.number(lane)]);
                          });
        }
    });
}

void TreelessPackets::occluded(const PrimitiveTable& table, std::span<const Ray> rays,
                               std::span<bool> occluded, RayQuery query) const {
    const auto done = [&](std::size_t i) { return occluded[i]; };
    for_each_block(rays, done, [&](RayBlock& block) {
        for (const PrimitiveId id : ids_) {
            if (!table.is_seen(id, query.mask)) continue;
            std::array<ShapeHit, kBlock> hits;
            for_each_lane(test_block(table, id, block, {}, hits.data(), query.stats),
                          [&](std::size_t lane) { occluded[block.number(lane)] = true; });
        }
    });
}

}  // namespace alhazen
