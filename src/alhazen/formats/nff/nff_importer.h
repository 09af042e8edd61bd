#pragma once

#include "alhazen/formats/core/importer.h"

namespace alhazen {

class NffImporter final : public Importer {
  public:
    [[nodiscard]] const char* name() const override { return "nff"; }
    [[nodiscard]] const char* description() const override;
    [[nodiscard]] int recognise(const ImportSource& source) const override;
    [[nodiscard]] SceneDescription import(const ImportSource& source,
                                          Diagnostics& diagnostics) const override;
};

}  // namespace alhazen
