#include "alhazen/scene_model/read_pictures.h"

#include <algorithm>
#include <set>

#include "alhazen/shading/materials/textures_of.h"

namespace alhazen {

namespace {

/// `has_second`: there is a second set of texture coordinates.
bool reads_first_set(const SceneDescription& description, MaterialId material, bool has_second) {
    const std::vector<TextureId> textures =
        textures_of(description.materials[static_cast<std::size_t>(material)].material);
    return std::any_of(textures.begin(), textures.end(), [&](TextureId id) {
        const auto* picture =
            std::get_if<ImageTexture>(&description.textures[static_cast<std::size_t>(id)].texture);
        return picture != nullptr && !(has_second && picture->uv_set == 1);
    });
}

}  // namespace

bool reads_pictures(const SceneDescription& description, MaterialId material) {
    return reads_first_set(description, material, false);
}

bool reads_pictures(const SceneDescription& description, MaterialId material,
                    const TriangleMesh& mesh) {
    const auto reads = [&](MaterialId id) {
        return reads_first_set(description, id, !mesh.uvs2.empty());
    };
    if (mesh.vertex_materials.empty()) return reads(material);
    const std::set<std::uint32_t> own(mesh.vertex_materials.begin(), mesh.vertex_materials.end());
    return std::any_of(own.begin(), own.end(),
                       [&](std::uint32_t id) { return reads(MaterialId{id}); });
}

}  // namespace alhazen
