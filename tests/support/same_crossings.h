#pragma once
/// Comparison of two shapes that are the same set of points.

#include <gtest/gtest.h>

#include <cstddef>

#include "alhazen/shapes/core/shape.h"
#include "support/random.h"

namespace alhazen::testing {

/// Rays meet both in the same places, at random and along a lattice; adds the number of their
/// crossings to `met`.
template <class Shape>
void expect_same_crossings(const Shape& a, const Shape& b, std::size_t& met) {
    Random random(57);
    for (int i = 0; i < 3000; ++i) {
        const bool lattice = i % 3 == 0;
        const Vec3 o = lattice ? random.on_lattice(3, 0.25) : random.in_cube(3);
        const Vec3 d = lattice ? random.lattice_direction() : random.in_cube(1) - 0.4 * o;
        ShapeHits hits, expected;
        a.intersect(line(o, d), hits);
        b.intersect(line(o, d), expected);
        ASSERT_EQ(hits.size(), expected.size()) << i;
        for (std::size_t k = 0; k < hits.size(); ++k) {
            ASSERT_NEAR(hits[k].t, expected[k].t, 1e-12) << i;
            const ShapeSurface at = a.surface(line(o, d), hits[k]);
            const ShapeSurface there = b.surface(line(o, d), expected[k]);
            ASSERT_LT(length(at.point - there.point), 1e-12) << i;
        }
        met += hits.size();
    }
}

}  // namespace alhazen::testing
