#pragma once
/// Imports scenes written as text in tests, and finds messages.

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <variant>

#include "alhazen/formats/core/importer.h"
#include "support/expect_near.h"

namespace alhazen::testing {

struct Imported {
    SceneDescription scene;
    Diagnostics diagnostics;

    [[nodiscard]] std::string messages() const {
        std::string all;
        for (const Diagnostic& d : diagnostics.all()) all += to_string(d) + "\n";
        return all;
    }
    [[nodiscard]] bool says(const std::string& text) const {
        return messages().find(text) != std::string::npos;
    }
    [[nodiscard]] std::size_t errors() const { return diagnostics.error_count(); }
    [[nodiscard]] const std::vector<Part>& parts() const { return scene.objects.at(0).parts; }
};

template <class SomeImporter>
Imported import_text(const std::string& text, const std::filesystem::path& path,
                     const ImportOptions& options = {}) {
    Imported result;
    const ImportSource source{text, path, options};
    result.scene = SomeImporter().import(source, result.diagnostics);
    return result;
}

inline const Material& material_of(const Imported& i, std::size_t part) {
    return i.scene.materials.at(static_cast<std::size_t>(i.parts().at(part).material)).material;
}

template <class S>
const S& shape_of(const Imported& i, std::size_t part = 0) {
    return std::get<S>(std::get<AnyShape>(i.parts().at(part).what));
}

}  // namespace alhazen::testing
