#pragma once
/// Importer of Bezier patch files: docs/reference/formats/bpt.md.

#include "alhazen/formats/core/importer.h"

namespace alhazen {

class BptImporter final : public Importer {
  public:
    [[nodiscard]] const char* name() const override { return "bpt"; }
    [[nodiscard]] const char* description() const override;
    [[nodiscard]] int recognise(const ImportSource& source) const override;
    [[nodiscard]] SceneDescription import(const ImportSource& source,
                                          Diagnostics& diagnostics) const override;
};

}  // namespace alhazen
