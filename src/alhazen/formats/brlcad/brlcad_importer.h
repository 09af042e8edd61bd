#pragma once

#include "alhazen/formats/core/importer.h"

namespace alhazen {

class BrlcadImporter final : public Importer {
  public:
    [[nodiscard]] const char* name() const override { return "brlcad"; }
    [[nodiscard]] const char* description() const override;
    [[nodiscard]] int recognise(const ImportSource& source) const override;
    [[nodiscard]] bool chooses_objects() const override { return true; }
    [[nodiscard]] bool reads_view_scripts() const override { return true; }
    [[nodiscard]] SceneDescription import(const ImportSource& source,
                                          Diagnostics& diagnostics) const override;
};

}  // namespace alhazen
