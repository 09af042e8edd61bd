#pragma once
/// All meshes of a scene with instances multiplied out, for formats that know triangles only.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "alhazen/formats/mesh_files/mesh_export.h"
#include "alhazen/scene_model/scene_description.h"

namespace alhazen {

/// What a scene shows, every instance counted. Sums stay at the largest number.
struct PlacedCounts {
    std::uint64_t meshes = 0;  ///< with at least one triangle
    std::uint64_t triangles = 0;
    std::array<std::uint64_t, AnalyticShapes::kCount> shapes{};  ///< by their place in the list
};
[[nodiscard]] PlacedCounts count_placed(const SceneDescription& description);

/// "2 spheres, 1 plane"; empty when there are none.
[[nodiscard]] std::string shapes_in_words(const PlacedCounts& counts);

/// In the order of the parts; meshes without triangles are left out. `material_names` [MaterialId].
/// Call with counts that fit in memory.
[[nodiscard]] std::vector<NamedMesh> placed_meshes(const SceneDescription& description,
                                                   const std::vector<std::string>& material_names);

}  // namespace alhazen
