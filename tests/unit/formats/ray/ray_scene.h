#pragma once
/// Common parts of the tests of .ray files: import from text, and access to the result.

#include <filesystem>
#include <string>

#include "alhazen/base/file.h"
#include "alhazen/formats/ray/ray_importer.h"
#include "unit/formats/text_scene.h"

namespace alhazen::testing {

/// A mesh of a square, up to its material.
inline constexpr const char* kSquareMesh =
    "points = ((0,0,0),(1,0,0),(1,1,0),(0,1,0)); faces = ((0,1,2,3)); ";

inline Imported import_ray(const std::string& body, const ImportOptions& options = {}) {
    return import_text<RayImporter>("SBT-raytracer 1.0\n" + body, "scene.ray", options);
}

inline Imported import_ray_file(const std::filesystem::path& path) {
    return import_text<RayImporter>(read_file(path), path);
}

}  // namespace alhazen::testing
