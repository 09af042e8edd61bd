#pragma once
/// The nearest of the hits of a ray, and ties: of two hits at equal t the one of the lower
/// primitive id wins, in whatever order they come. Every accelerator and every schedule decides
/// here.

#include "alhazen/geometry/hit.h"
#include "alhazen/geometry/ray.h"

namespace alhazen {

/// True where a crossing of the primitive `id` at `t` is nearer than `best`, or as near and wins the
/// tie. `id`: of the outermost instance, where there are instances around it.
[[nodiscard]] inline bool wins(double t, PrimitiveId id, const Hit& best) {
    return t < best.t || (t == best.t && id < best.top());
}

/// Makes a crossing the nearest hit where it wins. Then the ray ends there.
inline void offer_hit(const ShapeHit& crossing, PrimitiveId id, Ray& ray, Hit& best) {
    if (wins(crossing.t, id, best)) {
        // One by one: a crossing that was just put together would be waited for as a whole.
        best.t = crossing.t;
        best.u = crossing.u;
        best.v = crossing.v;
        best.part = crossing.part;
        best.primitive = id;
        best.path.clear();
        ray.t_max = crossing.t;
    }
}

}  // namespace alhazen
