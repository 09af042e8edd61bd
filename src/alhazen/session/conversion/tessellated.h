#pragma once
/// A scene whose exact shapes are replaced by triangles.
///
/// Conventions: the tolerance is in the units of the scene: in an object it is divided by the
/// largest stretch of its placements. Objects stay objects, instances stay instances; materials and
/// names are kept. A solid made of others becomes a group of one mesh. See shape_tessellation.h and
/// solids/solid_triangles.h for what the triangles are.

#include "alhazen/scene_model/scene_description.h"

namespace alhazen {

struct TessellationReport {
    std::uint64_t shapes = 0, triangles = 0;
    std::vector<std::string> kept;  ///< "FILE:L:C: plane: no triangles: the shape is endless"
};

/// Replaces each shape of a valid scene by a mesh within `tolerance` of it. Throws Error: Usage
/// where the tolerance is not a positive number; Scene, with one line for each part, where a shape
/// cannot be (it is endless, or open and no patch) and `keep_others` is false; Resource beyond
/// `max_triangles`.
[[nodiscard]] TessellationReport tessellate(SceneDescription& description, double tolerance,
                                            bool keep_others = false,
                                            std::uint64_t max_triangles = 50'000'000);

}  // namespace alhazen
