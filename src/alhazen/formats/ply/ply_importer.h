#pragma once
/// Importer of PLY meshes: docs/reference/formats/ply.md.

#include "alhazen/formats/core/importer.h"

namespace alhazen {

class PlyImporter final : public Importer {
  public:
    [[nodiscard]] const char* name() const override { return "ply"; }
    [[nodiscard]] const char* description() const override;
    [[nodiscard]] int recognise(const ImportSource& source) const override;
    [[nodiscard]] SceneDescription import(const ImportSource& source,
                                          Diagnostics& diagnostics) const override;
};

/// True if the bytes begin like a PLY file.
[[nodiscard]] bool looks_like_ply(std::string_view bytes);

}  // namespace alhazen
