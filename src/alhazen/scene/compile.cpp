#include <algorithm>

#include "alhazen/scene/compile_materials.h"
#include "alhazen/scene/geometry_compiler.h"
#include "alhazen/scene/scene.h"

namespace alhazen {

namespace {

bool tints_by_distance(const ShadingConventions& c) {
    return c.refraction_tint == ShadingConventions::RefractionTint::PerDistance ||
           c.shadow_tint == ShadingConventions::ShadowTint::PerDistance;
}

/// True if the part's surface encloses a volume and lets light through.
bool encloses(const SceneDescription& d, const Scene& scene, const Part& part) {
    const auto passes = [&](MaterialId id) {
        return opacity_of(scene.materials[static_cast<std::size_t>(id)]) != Opacity::Opaque;
    };
    if (const auto* shape = std::get_if<AnyShape>(&part.what)) {
        return passes(part.material) &&
               std::visit([](const auto& s) { return s.closed(); }, *shape);
    }
    const auto* index = std::get_if<MeshIndex>(&part.what);
    if (index == nullptr) return false;
    const TriangleMesh& mesh = *d.meshes[static_cast<std::size_t>(*index)].mesh;
    const std::vector<std::uint32_t>& own = mesh.vertex_materials;
    return (own.empty() ? passes(part.material)
                        : std::any_of(own.begin(), own.end(),
                                      [&](std::uint32_t id) { return passes(MaterialId{id}); })) &&
           mesh.closed();
}

void find_closed_parts(const SceneDescription& d, Scene& scene) {
    if (scene.all_opaque || !tints_by_distance(scene.conventions.shading)) return;
    for (const ObjectDescription& object : d.objects) {
        for (const Part& part : object.parts) {
            scene.closed_parts.push_back(encloses(d, scene, part) ? 1 : 0);
        }
    }
}

}  // namespace

Scene compile_without_geometry(const SceneDescription& description) {
    Scene scene;
    compile_materials(description, scene);
    scene.all_opaque =
        std::all_of(scene.materials.begin(), scene.materials.end(),
                    [](const Material& m) { return opacity_of(m) == Opacity::Opaque; });
    find_closed_parts(description, scene);
    scene.has_scattering =
        std::any_of(scene.materials.begin(), scene.materials.end(),
                    [](const Material& m) { return !m.scattering.coefficient.is_black(); });
    scene.census.texture_bytes = texture_bytes(scene.textures);
    scene.census.scene_bytes = scene.census.texture_bytes;
    return scene;
}

void build_aggregate(const SceneDescription& description, const CompileOptions& options,
                     Scene& scene) {
    GeometryCompiler(description, options, nullptr).build(scene);
}

void build_aggregate_taking_meshes(SceneDescription& description, const CompileOptions& options,
                                   Scene& scene) {
    GeometryCompiler(description, options, &description.meshes).build(scene);
}

Scene compile(const SceneDescription& description, const CompileOptions& options) {
    Scene scene = compile_without_geometry(description);
    build_aggregate(description, options, scene);
    return scene;
}

Scene compile_taking_meshes(SceneDescription& description, const CompileOptions& options) {
    Scene scene = compile_without_geometry(description);
    build_aggregate_taking_meshes(description, options, scene);
    return scene;
}

}  // namespace alhazen
