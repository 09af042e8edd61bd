#pragma once
/// A loaded, validated and compiled scene: the implementation of the Python class alhazen.Scene.
///
/// Threads: const functions may be called from many threads.

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "alhazen/session/load.h"
#include "alhazen/solids/solid_scene.h"
#include "alhazen/tracer/tracer.h"
#include "array_mesh.h"
#include "errors.h"
#include "placed_surfaces.h"

namespace alhazen::python {

/// Settings of the build of a scene.
struct BuildSettings {
    std::string accelerator = kDefaultAccelerator;
    std::string csg = "event_heap";
    std::string quality = "default";
    int threads = 0;
    bool strict = false;
    std::vector<std::string> allowed_folders = {};
    std::optional<double> time = {};
};

class BuiltScene {
  public:
    BuiltScene(SceneDescription source, LoadedScene loaded);

    /// Builds the contents of `base` (null: none), the meshes, and the blocks of the text, whose
    /// lines come from `origins`. File names are relative to `folder`. Throws Error.
    [[nodiscard]] static std::shared_ptr<BuiltScene> build(
        const BuiltScene* base, const std::vector<ArrayMesh>& meshes, const std::string& text,
        const Origins& origins, const std::string& folder, const BuildSettings& settings);
    /// Loads a file of any format. File names in later blocks are relative to the path `called`;
    /// "": to the file's own. Throws Error.
    [[nodiscard]] static std::shared_ptr<BuiltScene> load(const std::string& path,
                                                          const BuildSettings& settings,
                                                          const std::string& called);

    /// The scene as given, without additions for rendering.
    [[nodiscard]] const SceneDescription& source() const { return source_; }
    [[nodiscard]] const LoadedScene& loaded() const { return loaded_; }
    [[nodiscard]] const Tracer& tracer() const { return tracer_; }
    /// The solids; created on first use, which finds the closed geometry.
    [[nodiscard]] const SolidScene& solids() const;
    /// The solids if they have been created, else null.
    [[nodiscard]] const SolidScene* found_solids() const { return found_solids_; }
    /// The nearest-point structure; created on first use. Throws as PlacedSurfaces.
    [[nodiscard]] const PlacedSurfaces& nearest() const;
    /// The nearest-point structure if it has been created, else null.
    [[nodiscard]] const PlacedSurfaces* made_nearest() const { return made_nearest_; }

  private:
    SceneDescription source_;
    LoadedScene loaded_;
    Tracer tracer_;
    mutable std::once_flag solids_made_;
    mutable std::optional<SolidScene> solids_;
    mutable std::atomic<const SolidScene*> found_solids_ = nullptr;
    mutable std::once_flag nearest_made_;
    mutable std::optional<PlacedSurfaces> nearest_;
    mutable std::atomic<const PlacedSurfaces*> made_nearest_ = nullptr;
};

}  // namespace alhazen::python
