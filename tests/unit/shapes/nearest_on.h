#pragma once
/// The nearest point of a placed shape.

#include "alhazen/shapes/exact_surface.h"

namespace alhazen::testing {

template <class S>
PointOnSurface nearest_on(S shape, const Vec3& from, const Affine& place = {}) {
    shape.prepare();
    return ExactSurface(shape, {place, inverse(place)}).nearest(from);
}

}  // namespace alhazen::testing
