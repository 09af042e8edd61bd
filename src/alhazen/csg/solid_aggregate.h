#pragma once
/// The interface of aggregates that are one solid, such as a CSG object: the hits of a line are the
/// points at which it enters and leaves the solid, for any number of primitives.
///
/// Conventions: on a line (t_min = -inf, t_max = +inf) the hits alternate between entering and
/// leaving; a tangent is two equal hits or none. Callers (spans, measures) find the interface by
/// dynamic_cast, once per scene and never per ray.

#include "alhazen/primitives/aggregate.h"

namespace alhazen {

class SolidAggregate : public Aggregate {
  public:
    /// True if the line of the ray starts inside; always false for a bounded solid.
    [[nodiscard]] virtual bool inside_at_minus_infinity(const Ray& ray) const {
        (void)ray;
        return false;
    }
};

}  // namespace alhazen
