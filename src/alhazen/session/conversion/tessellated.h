#pragma once
/// Replaces the exact shapes of a scene by triangles.
///
/// Conventions: the tolerance is in the units of the scene; inside an object it is divided by the
/// largest stretch of the object's placements. Objects stay objects, instances stay instances;
/// materials and names are kept. A CSG solid becomes a group of one mesh. The tessellations are
/// described in shape_tessellation.h and solids/triangles/solid_triangles.h.

#include <cstdint>
#include <string>
#include <vector>

#include "alhazen/scene_model/scene_description.h"

namespace alhazen {

/// The largest number of triangles of a scene, before those of solids are merged.
inline constexpr std::uint64_t kMostTessellated = 50'000'000;

struct TessellationReport {
    std::uint64_t shapes = 0, triangles = 0;  ///< `shapes`: those that have triangles
    std::vector<std::string> kept;  ///< "FILE:L:C: plane: no triangles: the shape is endless"
    /// Solids and shapes without a triangle, and what triangles of solids do not have of the meshes
    /// they are cut from, a line each.
    std::vector<std::string> lost;
};

/// Replaces each shape of a valid scene by a mesh within `tolerance` of it. Throws Error: Usage if
/// the tolerance is not a positive number; Scene, with one line per part, if a shape has no
/// tessellation (it is unbounded, or open and no patch) and `keep_others` is false; Resource beyond
/// `max_triangles`. `threads` 0: all available cores.
[[nodiscard]] TessellationReport tessellate(SceneDescription& description, double tolerance,
                                            bool keep_others = false,
                                            std::uint64_t max_triangles = kMostTessellated,
                                            int threads = 0);

}  // namespace alhazen
