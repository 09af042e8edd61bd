#include <algorithm>
#include <optional>

#include "alhazen/scene/compile_materials.h"
#include "alhazen/scene/geometry_compiler.h"
#include "alhazen/scene/scene.h"
#include "alhazen/scene_model/scene_motion.h"
#include "alhazen/shapes/meshes/mesh_edges.h"

namespace alhazen {

namespace {

class ClosedParts {
  public:
    /// `opaque_too`: also opaque surfaces that enclose a volume.
    ClosedParts(const SceneDescription& description, const std::vector<Material>& materials,
                bool opaque_too)
        : d_(description),
          materials_(materials),
          opaque_too_(opaque_too),
          in_solid_(description.objects.size()),
          meshes_(description.meshes.size()) {
        for (std::size_t k = 0; k < d_.objects.size(); ++k) {
            if (d_.objects[k].combine != Combine::Group) mark_solid(k);
        }
    }

    [[nodiscard]] std::vector<std::uint8_t> find() {
        std::vector<std::uint8_t> closed;
        for (std::size_t k = 0; k < d_.objects.size(); ++k) {
            for (const Part& part : d_.objects[k].parts) {
                closed.push_back(in_solid_[k] || encloses(part) ? 1 : 0);
            }
        }
        return closed;
    }

  private:
    void mark_solid(std::size_t object) {
        if (in_solid_[object]) return;
        in_solid_[object] = true;
        for (const Part& part : d_.objects[object].parts) {
            if (const auto* child = std::get_if<ObjectIndex>(&part.what)) {
                mark_solid(static_cast<std::size_t>(*child));
            }
        }
    }
    [[nodiscard]] bool passes(MaterialId id) const {
        return opaque_too_ ||
               opacity_of(materials_[static_cast<std::size_t>(id)]) != Opacity::Opaque;
    }
    /// True if the part's surface encloses a volume, and lets light through where that counts.
    [[nodiscard]] bool encloses(const Part& part) {
        if (const auto* shape = std::get_if<AnyShape>(&part.what)) {
            return passes(part.material) &&
                   std::visit([](const auto& s) { return s.closed(); }, *shape);
        }
        const auto* index = std::get_if<MeshIndex>(&part.what);
        if (index == nullptr) return false;
        const TriangleMesh& mesh = *d_.meshes[static_cast<std::size_t>(*index)].mesh;
        const std::vector<std::uint32_t>& own = mesh.vertex_materials;
        const bool clear = own.empty() ? passes(part.material)
                                       : std::any_of(own.begin(), own.end(), [&](std::uint32_t id) {
                                             return passes(MaterialId{id});
                                         });
        if (!clear) return false;
        std::optional<bool>& known = meshes_[static_cast<std::size_t>(*index)];
        // Rays would enter a mesh that faces inward where they leave it.
        if (!known) known = mesh_edges(mesh).oriented() && signed_volume(mesh) > 0.0;
        return *known;
    }

    const SceneDescription& d_;
    const std::vector<Material>& materials_;
    const bool opaque_too_;
    std::vector<bool> in_solid_;               ///< [object] it, or one that uses it, is a solid
    std::vector<std::optional<bool>> meshes_;  ///< [mesh] closed and facing outward
};

}  // namespace

std::vector<std::uint8_t> closed_parts_of(const SceneDescription& description,
                                          const std::vector<Material>& materials, bool opaque_too) {
    return ClosedParts(description, materials, opaque_too).find();
}

/// See Scene::used_materials.
static std::vector<std::uint8_t> used_materials_of(const SceneDescription& description) {
    std::vector<std::uint8_t> used(description.materials.size());
    std::vector<bool> reached(description.objects.size());
    std::vector<std::size_t> open{static_cast<std::size_t>(description.root)};
    while (!open.empty()) {
        const std::size_t object = open.back();
        open.pop_back();
        if (object >= reached.size() || reached[object]) continue;
        reached[object] = true;
        for (const Part& part : description.objects[object].parts) {
            if (const auto* child = std::get_if<ObjectIndex>(&part.what)) {
                open.push_back(static_cast<std::size_t>(*child));
                continue;
            }
            const auto* index = std::get_if<MeshIndex>(&part.what);
            const TriangleMesh* const mesh =
                index == nullptr ? nullptr
                                 : description.meshes[static_cast<std::size_t>(*index)].mesh.get();
            if (mesh == nullptr || mesh->vertex_materials.empty()) {
                used[static_cast<std::size_t>(part.material)] = 1;
            } else {
                for (const std::uint32_t id : mesh->vertex_materials) used[id] = 1;
            }
        }
    }
    return used;
}

Scene compile_without_geometry(const SceneDescription& description) {
    Scene scene;
    compile_materials(description, scene);
    scene.used_materials = used_materials_of(description);
    scene.all_opaque =
        std::all_of(scene.materials.begin(), scene.materials.end(),
                    [](const Material& m) { return opacity_of(m) == Opacity::Opaque; });
    scene.may_be_passed = std::any_of(scene.materials.begin(), scene.materials.end(),
                                      [](const Material& m) { return m.may_be_passed(); });
    const ShadingConventions& shading = scene.conventions.shading;
    if (shading.inside_color || (!scene.all_opaque && shading.tints_by_distance())) {
        scene.closed_parts =
            closed_parts_of(description, scene.materials, shading.inside_color.has_value());
    }
    scene.has_scattering =
        std::any_of(scene.materials.begin(), scene.materials.end(),
                    [](const Material& m) { return !m.scattering.coefficient.is_black(); });
    scene.has_motion = geometry_moves(description);
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

}  // namespace alhazen
