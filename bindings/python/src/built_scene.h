#pragma once
/// A scene that is loaded, validated and compiled: what the Python class alhazen.Scene asks.
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

/// How a scene is built.
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

    /// Builds what `base` has (null: nothing), the meshes, and the blocks of the text, whose lines
    /// come from `origins`. File names are relative to `folder`. Throws Error.
    [[nodiscard]] static std::shared_ptr<BuiltScene> build(
        const BuiltScene* base, const std::vector<ArrayMesh>& meshes, const std::string& text,
        const Origins& origins, const std::string& folder, const BuildSettings& settings);
    /// Loads a file of any format. Files that are named later lie relative to the path `called`; ""
    /// for its own. Throws Error.
    [[nodiscard]] static std::shared_ptr<BuiltScene> load(const std::string& path,
                                                          const BuildSettings& settings,
                                                          const std::string& called);

    /// As it was given, without what rendering adds.
    [[nodiscard]] const SceneDescription& source() const { return source_; }
    [[nodiscard]] const LoadedScene& loaded() const { return loaded_; }
    [[nodiscard]] const Tracer& tracer() const { return tracer_; }
    /// Made on first use: finds which geometry is closed.
    [[nodiscard]] const SolidScene& solids() const;
    /// The same where they are found, else null.
    [[nodiscard]] const SolidScene* found_solids() const { return found_solids_; }
    /// Its triangles, made on first use; throws what PlacedSurfaces does.
    [[nodiscard]] const PlacedSurfaces& nearest() const;
    /// The same where they are made, else null.
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
