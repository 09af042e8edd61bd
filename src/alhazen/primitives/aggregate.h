#pragma once
/// The interface between renderers and accelerators: many primitives behind one virtual call per
/// ray.
///
/// Conventions: hits lie in [ray.t_min, ray.t_max]. At equal t the lower primitive id wins
/// (compared in the outermost aggregate first), so every accelerator gives the same hit. An invalid
/// ray hits nothing, and primitives that a query's mask does not see (geometry/ray_mask.h) are
/// ignored.
/// Threads: const functions may be called from many threads.

#include <cstddef>
#include <span>
#include <vector>

#include "alhazen/accel/core/traversal_stats.h"
#include "alhazen/geometry/bounds_source.h"
#include "alhazen/geometry/box.h"
#include "alhazen/geometry/hit.h"
#include "alhazen/geometry/motion/moving_box.h"
#include "alhazen/geometry/ray.h"
#include "alhazen/geometry/ray_columns.h"
#include "alhazen/geometry/ray_mask.h"

namespace alhazen {

class PrimitiveTable;
class LaneSolid;
struct Surface;

/// A hint about the rays of a batch; it never changes a hit.
enum class Coherence {
    Any,
    /// Neighbours in the list have similar directions and start or end near a common point: eye
    /// rays in tiles, shadow rays towards a point light. For other rays the hint costs time.
    Coherent,
};

/// Parameters of every query.
struct RayQuery {
    // Implicit, so that callers may pass only the statistics.
    RayQuery(TraversalStats* counted, RayMask sees = kAllRays, float when = 0.0f)
        : stats(counted), mask(sees), time(when) {}

    TraversalStats* stats;  ///< work is added here; null: not counted
    RayMask mask;           ///< mask of the rays
    float time;             ///< 0: the shutter opens; 1: it closes
};

class Aggregate {
  public:
    virtual ~Aggregate() = default;

    /// The table that the primitive ids of hits refer to.
    [[nodiscard]] virtual const PrimitiveTable& primitives() const = 0;
    /// The bounds of all primitives; unbounded when any primitive is.
    [[nodiscard]] virtual Box3 box() const = 0;
    /// A bounding sphere of all primitives. Default: the sphere around `box()`.
    [[nodiscard]] virtual BoundingSphere sphere() const;
    /// Bytes of the acceleration structure, without nested aggregates.
    [[nodiscard]] virtual std::size_t memory_bytes() const = 0;

    /// The nearest hit.
    [[nodiscard]] virtual bool closest(const Ray& ray, Hit& hit, RayQuery query) const = 0;
    /// True when there is any hit.
    [[nodiscard]] virtual bool occluded(const Ray& ray, RayQuery query) const = 0;
    /// Appends every hit; the appended ones are sorted by t, then by ids.
    virtual void all_hits(const Ray& ray, std::vector<Hit>& hits, RayQuery query) const = 0;
    /// For shadow rays: true when an opaque primitive is hit (`crossings` is then undefined);
    /// otherwise appends every hit, sorted as in `all_hits`: the transparent surfaces that tint the
    /// light.
    [[nodiscard]] virtual bool shadowed(const Ray& ray, std::vector<Hit>& crossings,
                                        RayQuery query) const = 0;

    /// Adds to the surface at a hit what the aggregate determines beyond the primitive. `primitive`
    /// is a primitive of this aggregate or the instance of the hit; `ray` is in the frame of the
    /// aggregate. Default: no change.
    virtual void complete(const Ray& ray, double t, PrimitiveId primitive, Surface& surface) const;
    /// True if `complete` may change a surface.
    [[nodiscard]] virtual bool completes_surfaces() const { return false; }
    /// The bounds of all primitives while the shutter is open. Default: nothing moves.
    [[nodiscard]] virtual MovingBox moving_box() const { return {box(), box()}; }

    /// True if `complete` may change the material.
    [[nodiscard]] virtual bool changes_materials() const { return false; }

    /// True if `complete` reverses the normals of a primitive. Where it does not change materials
    /// it only reverses normals and adds to errors.
    [[nodiscard]] virtual bool turns_normal(PrimitiveId) const { return false; }

    /// The interface for eight rays in lanes; null if lanes are not faster than single rays.
    [[nodiscard]] virtual const LaneSolid* lane_solid() const { return nullptr; }

    /// Sets `hits` (as long as `rays`) to the hits that `closest` finds. Faster than single rays
    /// from about ten rays on, in any order.
    virtual void closest_batch(std::span<const Ray> rays, std::span<Hit> hits, RayQuery query,
                               Coherence coherence = Coherence::Any) const;
    /// False if batches are a loop over single rays.
    [[nodiscard]] virtual bool gains_by_batches(Coherence) const { return true; }
    /// Sets `occluded` [ray] to the result of `Aggregate::occluded`.
    virtual void occluded_batch(std::span<const Ray> rays, std::span<bool> occluded, RayQuery query,
                                Coherence coherence = Coherence::Any) const;

    /// `closest_batch` for rays in columns, which are read in place by packets of coherent rays.
    virtual void closest_columns(const RayColumns& rays, const HitColumns& hits, RayQuery query,
                                 Coherence coherence = Coherence::Any) const;
    virtual void occluded_columns(const RayColumns& rays, std::span<bool> occluded, RayQuery query,
                                  Coherence coherence = Coherence::Any) const;

    /// `closest_batch` for rays with a time each; `times` is as long as `rays`. Default: nothing
    /// moves.
    virtual void closest_batch_at(std::span<const Ray> rays, std::span<const float> times,
                                  std::span<Hit> hits, RayQuery query, Coherence coherence) const;
    virtual void occluded_batch_at(std::span<const Ray> rays, std::span<const float> times,
                                   std::span<bool> occluded, RayQuery query,
                                   Coherence coherence) const;
};

/// The order of hits: by t, then by the ids from the outermost aggregate inward. Sorts must be
/// stable: crossings of one primitive at one t keep the order in which it reports them, so that the
/// first of all hits is the closest hit.
[[nodiscard]] bool hit_less(const Hit& a, const Hit& b);

/// Sorts the hits appended after the first `before` by `hit_less`.
void sort_appended(std::vector<Hit>& hits, std::size_t before);

}  // namespace alhazen
