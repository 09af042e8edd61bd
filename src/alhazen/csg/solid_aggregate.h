#pragma once
/// An aggregate that is one solid: the hits of a line with it are the places where the line enters
/// and leaves, whatever primitives make it up. CSG objects are such.
///
/// Conventions: on a line (t_min = -inf, t_max = +inf) the hits alternate between entering and
/// leaving; a tangent is two equal hits or none. What surrounds it (spans, measures) asks by
/// dynamic_cast, once per scene and never per ray.

#include "alhazen/primitives/aggregate.h"

namespace alhazen {

class SolidAggregate : public Aggregate {
  public:
    /// Whether the line of the ray begins inside; never for a bounded solid.
    [[nodiscard]] virtual bool inside_at_minus_infinity(const Ray& ray) const {
        (void)ray;
        return false;
    }
};

}  // namespace alhazen
