#pragma once
/// The order of hits that every accelerator and every batch schedule uses: the smaller t is nearer;
/// of a tie, at equal t, the lower primitive id wins, whatever the order of the tests.

#include "alhazen/geometry/hit.h"
#include "alhazen/geometry/ray.h"

namespace alhazen {

/// True if a crossing of primitive `id` at `t` precedes `best`. For a crossing inside instances
/// `id` is the outermost instance.
[[nodiscard]] inline bool wins(double t, PrimitiveId id, const Hit& best) {
    return t < best.t || (t == best.t && id < best.top());
}

/// Makes the crossing the nearest hit and ends the ray there, if it precedes `best`.
inline void offer_hit(const ShapeHit& crossing, PrimitiveId id, Ray& ray, Hit& best) {
    if (wins(crossing.t, id, best)) {
        // Member by member: a load of the whole crossing would wait for the stores that built it.
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
