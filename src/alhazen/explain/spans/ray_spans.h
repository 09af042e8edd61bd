#pragma once
/// The spans of a ray inside every solid of a scene, with those of the leaves of CSG solids.
///
/// Source: Roth 1982 (csg_spans.h; solids/spans.h).

#include <optional>
#include <string>
#include <vector>

#include "alhazen/explain/spans/csg_spans.h"
#include "alhazen/session/load.h"

namespace alhazen {

struct SolidSpans {
    std::string name;  ///< as in solids/solid_scene.h
    std::vector<TSpan> spans;
    std::optional<CsgSpanNode> combination;  ///< for a CSG solid
};

/// The solids that the ray enters or starts in, ordered by their first span.
[[nodiscard]] std::vector<SolidSpans> solid_spans(const LoadedScene& loaded, const Ray& ray);

}  // namespace alhazen
