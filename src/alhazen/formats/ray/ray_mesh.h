#pragma once
/// The `trimesh` / `polymesh` of the SBT-raytracer format.

#include "alhazen/formats/ray/ray_context.h"
#include "alhazen/formats/ray/ray_materials.h"
#include "alhazen/formats/text/text_tree.h"

namespace alhazen {

/// Reads a mesh block: points, faces (fans around the first vertex), vertex normals and materials,
/// gennormals. Adds it to the scene's meshes; none if the mesh is unusable. The materials of the
/// vertices start from `material`.
std::optional<MeshIndex> read_ray_mesh(BlockReader& reader, RayContext& context,
                                       RayMaterials& materials, const RayMaterial& material);

}  // namespace alhazen
