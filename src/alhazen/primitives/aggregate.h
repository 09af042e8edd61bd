#pragma once
/// Many primitives behind one virtual call per ray: the border between renderers and accelerators.
///
/// Conventions: hits lie in [ray.t_min, ray.t_max]. At equal t the lower primitive id wins
/// (compared in the outermost aggregate first), so every accelerator gives the same hit. An invalid
/// ray hits nothing, and what a query's mask does not see (geometry/ray_mask.h) is as if it were
/// not there. Threads: const functions may be called from many threads.

#include <cstddef>
#include <span>
#include <vector>

#include "alhazen/accel/core/traversal_stats.h"
#include "alhazen/geometry/bounds_source.h"
#include "alhazen/geometry/box.h"
#include "alhazen/geometry/hit.h"
#include "alhazen/geometry/ray.h"
#include "alhazen/geometry/ray_mask.h"

namespace alhazen {

class PrimitiveTable;
class LaneSolid;
struct Surface;

/// What is known of the rays of a batch: a hint, which never changes a hit.
enum class Coherence {
    Any,
    /// Neighbours in the list go nearly the same way and begin or end near a common point: eye rays
    /// in tiles, shadow rays towards a point light. On other rays the hint costs time.
    Coherent,
};

/// What goes with every query.
struct RayQuery {
    // Implicit, so that most callers say no more than where to count.
    RayQuery(TraversalStats* counted, RayMask sees = kAllRays) : stats(counted), mask(sees) {}

    TraversalStats* stats;  ///< what was done is added here; null: nothing is counted
    RayMask mask;           ///< what the rays see
};

class Aggregate {
  public:
    virtual ~Aggregate() = default;

    /// What the primitive ids of hits refer to.
    [[nodiscard]] virtual const PrimitiveTable& primitives() const = 0;
    /// Holds all primitives; unbounded when one of them is.
    [[nodiscard]] virtual Box3 box() const = 0;
    /// A sphere that holds them; by default the one around the box.
    [[nodiscard]] virtual BoundingSphere sphere() const;
    /// Bytes of the acceleration structure, nested aggregates not included.
    [[nodiscard]] virtual std::size_t memory_bytes() const = 0;

    /// The nearest hit.
    [[nodiscard]] virtual bool closest(const Ray& ray, Hit& hit, RayQuery query) const = 0;
    /// True when there is any hit.
    [[nodiscard]] virtual bool occluded(const Ray& ray, RayQuery query) const = 0;
    /// Appends every hit; the appended ones are sorted by t, then by ids.
    virtual void all_hits(const Ray& ray, std::vector<Hit>& hits, RayQuery query) const = 0;
    /// For shadow rays: true when an opaque primitive is hit (`crossings` is then meaningless);
    /// else appends every hit, sorted as in `all_hits`: the transparent surfaces that tint the
    /// light.
    [[nodiscard]] virtual bool shadowed(const Ray& ray, std::vector<Hit>& crossings,
                                        RayQuery query) const = 0;

    /// Changes what is known of the surface at a hit where the aggregate as a whole knows more than
    /// the primitive: its own one, or the instance that the hit came through; `ray` in the frame of
    /// the aggregate. By default nothing.
    virtual void complete(const Ray& ray, double t, PrimitiveId primitive, Surface& surface) const;
    /// Whether `complete` may change the material.
    [[nodiscard]] virtual bool changes_materials() const { return false; }

    /// The same primitives for rays side by side; null where these are no faster.
    [[nodiscard]] virtual const LaneSolid* lane_solid() const { return nullptr; }

    /// The nearest hit of every ray, as `closest` gives it; `hits` is as long as `rays`. Faster
    /// than ray by ray from about ten rays on, whatever their order.
    virtual void closest_batch(std::span<const Ray> rays, std::span<Hit> hits, RayQuery query,
                               Coherence coherence = Coherence::Any) const;
    /// Whether there is any hit on every ray.
    virtual void occluded_batch(std::span<const Ray> rays, std::span<bool> occluded, RayQuery query,
                                Coherence coherence = Coherence::Any) const;
};

/// The order of hits: by t, then by the ids from the outermost aggregate inward. Sorts must be
/// stable: crossings of one primitive at one t keep the order in which it reports them, so that the
/// first of all hits is the closest hit.
[[nodiscard]] bool hit_less(const Hit& a, const Hit& b);

/// Sorts by `hit_less` what a query appended beyond `before`.
void sort_appended(std::vector<Hit>& hits, std::size_t before);

}  // namespace alhazen
