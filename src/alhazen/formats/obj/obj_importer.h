#pragma once
/// Importer of Wavefront OBJ files with their material libraries: docs/reference/formats/obj.md.

#include "alhazen/formats/core/importer.h"

namespace alhazen {

class ObjImporter final : public Importer {
  public:
    [[nodiscard]] const char* name() const override { return "obj"; }
    [[nodiscard]] const char* description() const override;
    [[nodiscard]] int recognise(const ImportSource& source) const override;
    [[nodiscard]] SceneDescription import(const ImportSource& source,
                                          Diagnostics& diagnostics) const override;
};

/// True if the first statement of the text is an OBJ statement with valid arguments.
[[nodiscard]] bool looks_like_obj(std::string_view bytes);

}  // namespace alhazen
