#include "built_scene.h"

#include <filesystem>
#include <utility>

#include "alhazen/formats/core/default_conventions.h"
#include "alhazen/formats/native/read/native_fragment.h"

namespace alhazen::python {

namespace {

constexpr const char* kTextName = "<blocks>";

LoadOptions load_options(const BuildSettings& settings) {
    LoadOptions options;
    options.compile.accelerator = settings.accelerator;
    options.compile.csg = settings.csg;
    options.compile.build.quality = find_build_quality(settings.quality);
    options.threads = settings.threads;
    options.strict = settings.strict;
    options.import.time = settings.time;
    for (const std::string& folder : settings.allowed_folders) {
        options.import.allowed_folders.emplace_back(folder);
    }
    return options;
}

SceneDescription empty_description(const std::string& folder) {
    SceneDescription scene;
    scene.format = "native";
    scene.path = std::filesystem::path(folder) / "scene.alhazen";
    scene.conventions = default_conventions();
    scene.objects.push_back({"scene", {}, {}});
    return scene;
}

}  // namespace

BuiltScene::BuiltScene(SceneDescription source, LoadedScene loaded)
    : source_(std::move(source)), loaded_(std::move(loaded)), tracer_(Tracer::of(loaded_.scene)) {}

std::shared_ptr<BuiltScene> BuiltScene::build(const BuiltScene* base,
                                              const std::vector<ArrayMesh>& meshes,
                                              const std::string& text, const Origins& origins,
                                              const std::string& folder,
                                              const BuildSettings& settings) {
    const LoadOptions options = load_options(settings);
    SceneDescription scene = base != nullptr ? base->source() : empty_description(folder);
    for (const ArrayMesh& mesh : meshes) {
        scene.meshes.push_back({mesh.name, mesh.mesh, mesh.location, {}});
    }
    Diagnostics found;
    read_native_fragment(text, kTextName, options.import, scene, found);
    if (found.error_count() == 0) validate(scene, found);
    Diagnostics diagnostics = at_origins(found, kTextName, origins);
    throw_found(diagnostics);
    if (options.strict) diagnostics.throw_if_warnings();
    LoadedScene loaded = alhazen::load(scene, std::move(diagnostics), options);
    return std::make_shared<BuiltScene>(std::move(scene), std::move(loaded));
}

std::shared_ptr<BuiltScene> BuiltScene::load(const std::string& path, const BuildSettings& settings,
                                             const std::string& called) {
    const LoadOptions options = load_options(settings);
    Diagnostics diagnostics;
    SceneDescription scene;
    try {
        scene = load_description(path, options, diagnostics);
    } catch (const Error& error) {
        if (error.location().file.empty()) throw_found(diagnostics);
        throw;
    }
    if (!called.empty()) scene.path = called;
    LoadedScene loaded = alhazen::load(scene, std::move(diagnostics), options);
    return std::make_shared<BuiltScene>(std::move(scene), std::move(loaded));
}

const SolidScene& BuiltScene::solids() const {
    std::call_once(solids_made_, [this] {
        solids_.emplace(loaded_.description, loaded_.scene);
        found_solids_ = &*solids_;
    });
    return *solids_;
}

const PlacedSurfaces& BuiltScene::nearest() const {
    std::call_once(nearest_made_, [this] {
        nearest_.emplace(tracer_, loaded_.description);
        made_nearest_ = &*nearest_;
    });
    return *nearest_;
}

}  // namespace alhazen::python
