#pragma once
/// Random values for fields of shapes, and the generic maker of random shapes.

#include "alhazen/shapes/shape_list.h"
#include "support/random.h"

namespace alhazen::testing {

/// Source of random values: of any size and direction, or on a coarse grid and along the axes.
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

/// Sets the value of a field by its unit. Not for fields of Unit::Text, Count and Compound.
inline void make_field(const ShapeSource& from, Unit unit, Vec3& value) {
    const auto number = [&] { return from.random.uniform(-1, 1); };
    value = unit == Unit::Point    ? from.point()
            : unit == Unit::Number ? Vec3{number(), number(), number()}
                                   : from.vector();
}
inline void make_field(const ShapeSource& from, Unit unit, double& value) {
    value = unit == Unit::Length ? from.length() : from.random.uniform(0.1, 0.9);
}
inline void make_field(const ShapeSource& from, Unit, bool& value) {
    value = from.random.below(4) != 0;
}

/// Makes random shapes of type S: sets the fields in order by their units until the shape is valid.
/// Shapes whose fields depend on each other or have other types have a specialisation in
/// random_shapes.h.
template <class S>
struct RandomShape {
    static S make(const ShapeSource& from) {
        for (;;) {
            S shape;
            for_each_field<S>(
                [&](const auto& field) { make_field(from, field.unit, shape.*field.member); });
            Diagnostics findings;
            shape.validate({}, findings);
            if (findings.error_count() == 0) return shape;
        }
    }
};

}  // namespace alhazen::testing
