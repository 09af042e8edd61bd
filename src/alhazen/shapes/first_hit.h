#pragma once
/// The first crossing of a ray with shapes that find it in less time than all of them.
///
/// Source: polynomial_solid.h. Differs: nothing. Conventions: the same bits as the first crossing
/// that `intersect` writes; false where that writes none. A shape with an overload here has to keep
/// the two true to each other, and to join first_hit_test.cpp, which compares them.

#include "alhazen/shapes/algebraic.h"
#include "alhazen/shapes/tgc.h"
#include "alhazen/shapes/torus.h"

namespace alhazen {

[[nodiscard]] bool first_hit(const Algebraic& shape, const Ray& ray, ShapeHit& hit);
[[nodiscard]] bool first_hit(const Tgc& shape, const Ray& ray, ShapeHit& hit);
[[nodiscard]] bool first_hit(const Torus& shape, const Ray& ray, ShapeHit& hit);

/// For any shape: by its overload above, or the first of all crossings.
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
