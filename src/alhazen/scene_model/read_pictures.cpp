#include "alhazen/scene_model/read_pictures.h"

#include <algorithm>
#include <set>

#include "alhazen/shading/materials/textures_of.h"

namespace alhazen {

bool reads_pictures(const SceneDescription& description, MaterialId material) {
    const std::vector<TextureId> textures =
        textures_of(description.materials[static_cast<std::size_t>(material)].material);
    return std::any_of(textures.begin(), textures.end(), [&](TextureId id) {
        return std::holds_alternative<ImageTexture>(
            description.textures[static_cast<std::size_t>(id)].texture);
    });
}

bool reads_pictures(const SceneDescription& description, MaterialId material,
                    const TriangleMesh& mesh) {
    if (mesh.vertex_materials.empty()) return reads_pictures(description, material);
    const std::set<std::uint32_t> own(mesh.vertex_materials.begin(), mesh.vertex_materials.end());
    return std::any_of(own.begin(), own.end(), [&](std::uint32_t id) {
        return reads_pictures(description, MaterialId{id});
    });
}

}  // namespace alhazen
