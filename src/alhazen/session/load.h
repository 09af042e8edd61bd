#pragma once
/// Loads a scene: reads, validates and compiles it, and measures the time of each phase.

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "alhazen/base/progress.h"
#include "alhazen/formats/core/importer.h"
#include "alhazen/scene/scene.h"

namespace alhazen {

struct LoadedScene;

struct LoadOptions {
    ImportOptions import;
    CompileOptions compile;
    std::optional<Shutter> shutter;  ///< replaces that of the file
    int threads = 0;                 ///< for the build; 0 = all available cores
    /// True: warnings are errors: a scene that cannot be read completely and literally is refused,
    /// and so are options of the build without effect.
    bool strict = false;
    /// False: meshes that are placed once may be moved into the scene and are then null in the
    /// description.
    bool keep_meshes = true;
    /// False: the scene has no aggregate until `build_aggregate`.
    bool with_aggregate = true;
    /// Unless empty, chooses the quality of the build of a scene that has no aggregate yet.
    std::function<BuildQuality(const LoadedScene&)> choose_quality;
    ProgressSink* progress = nullptr;
};

struct LoadedScene {
    SceneDescription description;
    Scene scene;
    Diagnostics diagnostics;             ///< warnings
    std::uint64_t load_peak_bytes = 0;   ///< largest resident set of the process after reading
    std::uint64_t build_peak_bytes = 0;  ///< the same after building
    double load_seconds = 0;
    double build_seconds = 0;
    BuildQuality quality = BuildQuality::Default;  ///< of the aggregate
};

/// Says that options of the wide BVH have no effect on a scene, because it has none; else empty.
[[nodiscard]] std::string idle_build_options(const SceneDescription& description,
                                             const CompileOptions& compile);

/// Reads and validates a scene file without building anything. Throws Error.
[[nodiscard]] SceneDescription load_description(const std::filesystem::path& path,
                                                const LoadOptions& options,
                                                Diagnostics& diagnostics);

/// Reads, validates and compiles. Throws Error.
[[nodiscard]] LoadedScene load(const std::filesystem::path& path, const LoadOptions& options = {});

/// Loads a valid description from another source; `diagnostics` are its warnings.
[[nodiscard]] LoadedScene load(SceneDescription description, Diagnostics diagnostics,
                               const LoadOptions& options = {});

/// Builds the aggregate if the scene has none, and adds to the times. Throws Error.
void build_aggregate(LoadedScene& loaded, const LoadOptions& options);

}  // namespace alhazen
