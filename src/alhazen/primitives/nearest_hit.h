#pragma once
/// The nearest of the hits of a ray, and ties: of two hits at equal t the one of the lower
/// primitive id wins, in whatever order they come. Every accelerator and every schedule decides
/// here.

#include "alhazen/geometry/hit.h"
#include "alhazen/geometry/ray.h"

namespace alhazen {

/// Offers a crossing as the new nearest hit: it wins when it is nearer, or equally near with a
/// lower id. Then the ray ends there.
inline void offer(const ShapeHit& crossing, PrimitiveId id, Ray& ray, Hit& best) {
    if (crossing.t < best.t || (crossing.t == best.t && id < best.top())) {
        static_cast<ShapeHit&>(best) = crossing;
        best.primitive = id;
        best.path.clear();
        ray.t_max = crossing.t;
    }
}

}  // namespace alhazen
