#pragma once
/// Converts glTF materials to materials of a scene, with unchanged parameters.
///
/// Source: Khronos, "glTF 2.0 Specification", 2021, section 3.9 and the KHR_materials extensions
/// of docs/reference/formats/gltf.md.

#include "alhazen/formats/gltf/scene/gltf_textures.h"

namespace alhazen::gltf {

/// Adds the materials of the document to `scene` in their order.
void add_materials(const Document& document, const ImportSource& source, SceneDescription& scene,
                   Diagnostics& diagnostics);

/// The material of primitives without one; added to `scene` at its first use.
class DefaultMaterial {
  public:
    explicit DefaultMaterial(SceneDescription& scene) : scene_(scene) {}
    [[nodiscard]] MaterialId id();

  private:
    SceneDescription& scene_;
    std::optional<MaterialId> id_;
};

}  // namespace alhazen::gltf
