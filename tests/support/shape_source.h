#pragma once
/// Number source of random shapes, and the makers' common declaration.

#include "alhazen/shapes/shape_list.h"
#include "support/random.h"

namespace alhazen::testing {

/// Number source of a random shape: anywhere, or on a coarse grid and along the axes.
struct ShapeSource {
    Random& random;
    bool lattice = false;

    Vec3 point() const { return lattice ? random.on_lattice(2, 0.5) : random.in_cube(30); }
    Vec3 vector() const {
        if (!lattice) return random.log_uniform(0.1, 10) * random.unit_vector();
        Vec3 v{};
        v[random.below(3)] = random.sign() * length();
        return v;
    }
    double length() const {
        return lattice ? 0.5 * (1 + random.below(4)) : random.log_uniform(0.05, 20);
    }
};

template <class>
inline constexpr bool kNoMaker = false;

template <class S>
struct RandomShape {
    static_assert(kNoMaker<S>,
                  "A new shape needs a RandomShape<S> in tests/support/random_shapes.h; the "
                  "conformance tests then run on it.");
};

}  // namespace alhazen::testing
