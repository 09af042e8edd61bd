#pragma once
/// Manifold walks of specular chains: iterates a chain until it leads to a given light, and
/// computes the light's contribution along it.
///
/// Source: Jakob and Marschner, "Manifold Exploration", SIGGRAPH 2012 (the walk, section 4);
/// Hanika, Droske and Fascione, "Manifold Next Event Estimation", EGSR 2015 (towards a light);
/// Zeltner, Georgiev and Jakob, "Specular Manifold Sampling for Rendering High-Frequency Caustics
/// and Glints", SIGGRAPH 2020 (section 4.4: the angle between directions as the constraint).
/// Differs: the chain is traced from its first vertex, so that all vertices but the last obey the
/// law of reflection or refraction at every step: two unknowns for any length. Steps are halved
/// until the angle decreases.
/// Conventions: the end is a point, or the direction to an infinitely distant light.

#include "alhazen/renderers/manifold/specular_chain.h"

namespace alhazen {

struct ChainEnd {
    Vec3 at;
    bool infinite = false;
};

/// Iterates `chain`, which starts at `from`, until it leads to the end. False if it does not
/// converge.
[[nodiscard]] bool walk_to(const ChainTracer& tracer, const ShapeSurface& from, std::uint64_t part,
                           const ChainIndices& indices, const ChainEnd& end, float time,
                           Chain& chain);

/// Solid angle of first directions per area perpendicular to the last direction at the end; for an
/// infinitely distant end, per solid angle of last directions. 0 if undefined.
[[nodiscard]] double spread_ratio(const ChainTracer& tracer, const Chain& chain,
                                  const ChainEnd& end, float time);

}  // namespace alhazen
