#pragma once
/// Importer of STL files: docs/reference/formats/stl.md.

#include "alhazen/formats/core/importer.h"

namespace alhazen {

class StlImporter final : public Importer {
  public:
    [[nodiscard]] const char* name() const override { return "stl"; }
    [[nodiscard]] const char* description() const override;
    [[nodiscard]] int recognise(const ImportSource& source) const override;
    [[nodiscard]] SceneDescription import(const ImportSource& source,
                                          Diagnostics& diagnostics) const override;
};

}  // namespace alhazen
