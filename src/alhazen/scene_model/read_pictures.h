#pragma once
/// Whether materials have pictures, which are looked up by texture coordinates of the first set.

#include "alhazen/scene_model/scene_description.h"

namespace alhazen {

[[nodiscard]] bool reads_pictures(const SceneDescription& description, MaterialId material);
/// The same of any material of a mesh: those of its vertices, without them `material`. Pictures of
/// the second set count if the mesh has none.
[[nodiscard]] bool reads_pictures(const SceneDescription& description, MaterialId material,
                                  const TriangleMesh& mesh);

}  // namespace alhazen
