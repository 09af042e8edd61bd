#pragma once
/// Imports scenes written as text in tests, and finds messages.

#include <filesystem>
#include <string>

#include "alhazen/formats/core/importer.h"

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

}  // namespace alhazen::testing
