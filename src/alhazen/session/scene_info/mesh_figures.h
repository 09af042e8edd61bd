#pragma once
/// Counts, area and volume of a mesh, and of all meshes as placed in a scene.
///
/// Conventions: volumes are signed, positive where the surface is wound outward; a mirroring
/// placement keeps the sign, because the outside stays outside. The volume of an open mesh is not
/// meaningful.

#include <cstdint>
#include <optional>
#include <vector>

#include "alhazen/scene_model/scene_description.h"
#include "alhazen/shapes/meshes/mesh_edges.h"

namespace alhazen {

struct MeshFigures {
    std::size_t triangles = 0, vertices = 0;
    std::size_t unused_vertices = 0;  ///< used by no triangle
    double area = 0, volume = 0;
    std::optional<MeshEdges> edges;  ///< none: not tested
};

/// `look_if_closed` sorts all edges: O(n log n), otherwise O(n).
[[nodiscard]] MeshFigures figures_of(const TriangleMesh& mesh, bool look_if_closed);

struct PlacedFigures {
    double area = 0, volume = 0;
};

/// Sums over all meshes as placed, instances expanded. `meshes` [MeshIndex] are their own figures.
/// None beyond the limit of steps (many nested non-uniform scalings).
[[nodiscard]] std::optional<PlacedFigures> placed_figures(const SceneDescription& description,
                                                          const std::vector<MeshFigures>& meshes);

}  // namespace alhazen
