#pragma once
/// Common parts of the tests of the native format: import from text, and access to the result.

#include <filesystem>
#include <string>

#include "alhazen/base/file.h"
#include "alhazen/formats/native/read/native_importer.h"
#include "unit/formats/text_scene.h"

namespace alhazen::testing {

inline Imported import_native(const std::string& body, const ImportOptions& options = {}) {
    return import_text<NativeImporter>("alhazen 1\n" + body, "scene.alhazen", options);
}

inline Imported import_native_file(const std::filesystem::path& path,
                                   const ImportOptions& options = {}) {
    return import_text<NativeImporter>(read_file(path), path, options);
}

}  // namespace alhazen::testing
