#pragma once
/// From a scene file to a scene that can be traced, with the time that each phase took.

#include <filesystem>
#include <string>

#include "alhazen/base/progress.h"
#include "alhazen/importers/importer.h"
#include "alhazen/scene/scene.h"

namespace alhazen {

struct LoadOptions {
    ImportOptions import;
    CompileOptions compile;
    int threads = 0;  ///< for the build; 0 = all available cores
    ProgressSink* progress = nullptr;
};

struct LoadedScene {
    SceneDescription description;
    Scene scene;
    Diagnostics diagnostics;  ///< warnings
    double load_seconds = 0;
    double build_seconds = 0;
};

/// Reads and validates a scene file without building anything.
[[nodiscard]] SceneDescription load_description(const std::filesystem::path& path,
                                                const LoadOptions& options,
                                                Diagnostics& diagnostics);

/// Reads, validates and compiles. Throws Error.
[[nodiscard]] LoadedScene load(const std::filesystem::path& path, const LoadOptions& options = {});

}  // namespace alhazen
