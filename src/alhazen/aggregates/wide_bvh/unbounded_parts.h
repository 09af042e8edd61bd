#pragma once
/// The primitives without bounds, which are outside the tree: every ray is tested against all of
/// them.
///
/// Planes without a placement are tested here, with the arithmetic of Plane.
/// Conventions: hits and counts are those of PrimitiveTable; an invalid ray hits nothing.

#include <span>
#include <vector>

#include "alhazen/aggregates/wide_bvh/wide_bvh_kernels.h"
#include "alhazen/primitives/nearest_hit.h"
#include "alhazen/primitives/primitive_table.h"
#include "alhazen/primitives/unused_shear.h"
#include "alhazen/shapes/core/shape_numerics.h"

namespace alhazen {

class UnboundedParts {
  public:
    UnboundedParts() = default;
    UnboundedParts(const PrimitiveTable& table, std::span<const PrimitiveId> ids);

    [[nodiscard]] bool empty() const { return parts_.empty(); }

    /// As PrimitiveTable::closest for each primitive.
    void closest(const PrimitiveTable& table, const Ray& ray, Hit& best, RayQuery query) const {
        if (!parts_.empty()) [[unlikely]] {
            closest_of_some(table, ray, best, query);
        }
    }
    [[nodiscard]] bool occluded(const PrimitiveTable& table, const Ray& ray, RayQuery query) const {
        return !parts_.empty() && occluded_by_some(table, ray, query);
    }
    void all_hits(const PrimitiveTable& table, const Ray& ray, std::vector<Hit>& hits,
                  RayQuery query) const {
        if (parts_.empty()) return;
        meet(table, ray, query, [&](PrimitiveId id, const ShapeHit* hit, auto stats) {
            if (hit != nullptr) {
                append_hit(hits, *hit, id);
            } else {
                table.all_hits(id, ray, shear_of(table, id, ray), hits, stats, query.mask);
            }
            return false;
        });
    }
    /// True if one of them blocks the ray.
    [[nodiscard]] bool shadowed(const PrimitiveTable& table, const Ray& ray,
                                std::vector<Hit>& crossings, RayQuery query) const {
        if (parts_.empty()) return false;
        return meet(table, ray, query, [&](PrimitiveId id, const ShapeHit* hit, auto stats) {
            if (hit == nullptr) {
                return table.shadowed(id, ray, shear_of(table, id, ray), crossings, stats,
                                      query.mask);
            }
            if (table.is_opaque(id)) return true;
            append_hit(crossings, *hit, id);
            return false;
        });
    }

  private:
    // Not inline: most scenes have no unbounded primitives, and every ray would pay for the room
    // that these take on the stack.
    [[gnu::noinline]] void closest_of_some(const PrimitiveTable& table, const Ray& ray, Hit& best,
                                           RayQuery query) const;
    [[nodiscard, gnu::noinline]] bool occluded_by_some(const PrimitiveTable& table, const Ray& ray,
                                                       RayQuery query) const;

    /// The shear is needed for triangles beyond BoundedPrimitives::kReach.
    [[nodiscard]] static RayShear shear_of(const PrimitiveTable& table, PrimitiveId id,
                                           const Ray& ray) {
        return table.kind(id) == kTriangleKind ? RayShear(ray.direction) : kUnusedShear;
    }
    struct Part {
        PrimitiveId id;
        bool is_plane = false;
        Vec3 point, unit_normal;  ///< of a plane
    };

    /// Calls test(id, hit, stats) until it returns true: for planes that are hit, and with a null
    /// pointer for primitives to be tested through the table.
    template <class Test>
    bool meet(const PrimitiveTable& table, const Ray& ray, RayQuery query, Test&& test) const {
        return with_stats(query.stats, [&](auto stats) {
            for (const Part& part : parts_) {
                if (!part.is_plane) {
                    if (is_valid(ray) && test(part.id, nullptr, stats)) return true;
                    continue;
                }
                if (!table.is_seen(part.id, query.mask)) continue;
                const double t = plane_crossing(ray, part.point, part.unit_normal);
                if constexpr (decltype(stats)::kCounts) {
                    if (!is_valid(ray)) return false;
                    stats.primitives(1);
                }
                ShapeHit hit;
                if (report_crossing(ray, {t, 0, 0, 0}, &hit) == 0 || !is_valid(ray)) continue;
                stats.primitive_hits(1);
                if (test(part.id, &hit, stats)) return true;
            }
            return false;
        });
    }

    std::vector<Part> parts_;
};

}  // namespace alhazen
