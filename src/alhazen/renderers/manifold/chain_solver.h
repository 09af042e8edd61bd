#pragma once
/// Walks on the manifold of specular chains: a chain that leads somewhere is changed until it leads
/// to a given light; and how much of that light comes along it.
///
/// Source: Jakob and Marschner, "Manifold Exploration", SIGGRAPH 2012 (the walk, section 4);
/// Hanika, Droske and Fascione, "Manifold Next Event Estimation", EGSR 2015 (towards a light);
/// Zeltner, Georgiev and Jakob, "Specular Manifold Sampling for Rendering High-Frequency Caustics
/// and Glints", SIGGRAPH 2020 (section 4.4: the angle between directions as the constraint).
/// Differs: all vertices but the last obey their law at every step, as the chain is traced from the
/// first: two unknowns whatever its length. Steps are halved until the angle falls.
/// Conventions: the end is a point, or the direction to light infinitely far away.

#include "alhazen/renderers/manifold/specular_chain.h"

namespace alhazen {

struct ChainEnd {
    Vec3 at;
    bool infinite = false;
};

/// Changes `chain`, which starts at `from`, until it leads to the end. False: it does not get
/// there.
[[nodiscard]] bool walk_to(const ChainTracer& tracer, const ShapeSurface& from, std::uint64_t part,
                           const ChainIndices& indices, const ChainEnd& end, float time,
                           Chain& chain);

/// Solid angle of first directions for an area across the last one at the end; for an end
/// infinitely far away, for a solid angle of last directions. 0: there is none.
[[nodiscard]] double spread_ratio(const ChainTracer& tracer, const Chain& chain,
                                  const ChainEnd& end, float time);

}  // namespace alhazen
