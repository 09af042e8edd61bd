#pragma once
/// All meshes of a scene with instances expanded, for triangle-only formats.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "alhazen/formats/mesh_files/mesh_export.h"
#include "alhazen/scene_model/scene_description.h"

namespace alhazen {

/// Numbers of primitives of a scene, instances expanded. Sums saturate.
struct PlacedCounts {
    std::uint64_t meshes = 0;  ///< with at least one triangle
    std::uint64_t triangles = 0;
    std::array<std::uint64_t, AnalyticShapes::kCount> shapes{};  ///< by position in the shape list
};
[[nodiscard]] PlacedCounts count_placed(const SceneDescription& description);

/// "2 spheres, 1 plane"; empty without shapes.
[[nodiscard]] std::string shapes_in_words(const PlacedCounts& counts);

/// All placed meshes in the order of the parts; meshes without triangles are omitted.
/// `material_names` [MaterialId] must outlive them. Precondition: the counts fit in memory.
[[nodiscard]] std::vector<NamedMesh> placed_meshes(const SceneDescription& description,
                                                   const std::vector<std::string>& material_names);

}  // namespace alhazen
