#pragma once
/// The traversal of one ray through an accelerator: visited cells, tested bounds and primitives, in
/// order, as shapes for drawing.
///
/// Source: the figures of the papers on each accelerator.
/// Differs: the steps are recorded from the actual traversal (accel/core/traversal_trace.h).

#include <string>
#include <vector>

#include "alhazen/scene/scene.h"

namespace alhazen {

struct TraversalStep {
    enum class Kind { Cell, Bound, Beam, Primitive };

    Kind kind = Kind::Cell;
    bool met = true;            ///< the ray intersects the bound or hits the primitive
    std::uint32_t number = 0;   ///< number of the cell, node or primitive
    std::vector<Vec3> corners;  ///< of the convex cell or bound; none for a primitive
};

struct TraversalTrace {
    std::string accelerator;
    Ray ray;
    std::vector<TraversalStep> steps;
    Hit hit;
};

/// The accelerators that can be traced, as names separated by commas.
[[nodiscard]] std::string traceable_accelerators();

/// Traces the closest hit of `ray` with an accelerator ("NAME:SETTING=VALUE,...") over the
/// outermost primitives of the scene, without the contents of instances. Throws Error (Usage) for
/// an accelerator that cannot be traced.
[[nodiscard]] TraversalTrace trace_traversal(const Scene& scene, const std::string& accelerator,
                                             const Ray& ray);

}  // namespace alhazen
