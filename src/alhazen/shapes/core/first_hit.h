#pragma once
/// The first crossing of a ray with any shape: the shape's own `first_hit`, which is faster than
/// finding all crossings, else the first of all crossings.
///
/// Conventions: returns the same bits as the first crossing that `intersect` writes, or false where
/// it writes none. A shape declares `bool first_hit(const S&, const Ray&, ShapeHit&)` in its own
/// header; first_hit_test.cpp compares the two.

#include "alhazen/shapes/core/shape.h"
#include "alhazen/shapes/core/shape_hits.h"

namespace alhazen {

template <Shape S>
[[nodiscard]] inline bool find_first_hit(const S& shape, const Ray& ray, ShapeHit& hit) {
    if constexpr (requires { first_hit(shape, ray, hit); }) {
        return first_hit(shape, ray, hit);
    } else if constexpr (WritesManyHits<S>) {
        ShapeHits hits(1);
        shape.intersect(ray, hits);
        if (hits.empty()) return false;
        hit = hits.front();
        return true;
    } else {
        ShapeHit hits[S::kMaxHits];
        if (shape.intersect(ray, hits) == 0) return false;
        hit = hits[0];
        return true;
    }
}

}  // namespace alhazen
