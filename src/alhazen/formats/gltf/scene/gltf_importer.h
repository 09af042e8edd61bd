#pragma once
/// Importer of glTF 2.0 scenes: .gltf with external files or data URIs, and .glb.
///
/// Source: Khronos, "glTF 2.0 Specification", 2021, and the extensions listed in
/// docs/reference/formats/gltf.md.
/// Differs: points and lines are left out; see docs/reference/formats/gltf.md.

#include "alhazen/formats/core/importer.h"

namespace alhazen {

class GltfImporter final : public Importer {
  public:
    [[nodiscard]] const char* name() const override { return "gltf"; }
    [[nodiscard]] const char* description() const override;
    [[nodiscard]] int recognise(const ImportSource& source) const override;
    [[nodiscard]] bool applies_animations() const override { return true; }
    [[nodiscard]] SceneDescription import(const ImportSource& source,
                                          Diagnostics& diagnostics) const override;
};

}  // namespace alhazen
