#pragma once
/// How much of a mesh there is, and of all meshes as a scene places them.
///
/// Conventions: volumes are signed, positive where the surface is wound outward; a placement that
/// mirrors keeps the outside outside, so it keeps the sign. Of an open mesh the volume means
/// little.

#include <cstdint>
#include <optional>
#include <vector>

#include "alhazen/scene_model/scene_description.h"

namespace alhazen {

struct MeshFigures {
    std::size_t triangles = 0, vertices = 0;
    std::size_t unused_vertices = 0;  ///< of no triangle
    double area = 0, volume = 0;
    std::optional<bool> closed;  ///< none when it was not looked at
};

/// `look_if_closed` costs a sort of all edges. O(n log n), else O(n).
[[nodiscard]] MeshFigures figures_of(const TriangleMesh& mesh, bool look_if_closed);

struct PlacedFigures {
    double area = 0, volume = 0;
};

/// Sums over all meshes as placed, instances multiplied out. `meshes` [MeshIndex] are their own
/// figures. None when it would take too long: many uneven scalings nested in one another.
[[nodiscard]] std::optional<PlacedFigures> placed_figures(const SceneDescription& description,
                                                          const std::vector<MeshFigures>& meshes);

}  // namespace alhazen
