#include "alhazen/formats/gltf/scene/gltf_importer.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "alhazen/base/lower_case.h"
#include "alhazen/formats/gltf/document/gltf_budget.h"
#include "alhazen/formats/gltf/document/gltf_document.h"
#include "alhazen/formats/gltf/scene/gltf_animation.h"
#include "alhazen/formats/gltf/scene/gltf_materials.h"
#include "alhazen/formats/gltf/scene/gltf_nodes.h"
#include "alhazen/formats/gltf/scene/gltf_views.h"

namespace alhazen {

namespace {

Conventions gltf_conventions() {
    Conventions c;
    c.shading.highlight = ShadingConventions::Highlight::BlinnPhong;
    c.shading.shadow_tint = ShadingConventions::ShadowTint::PerCrossing;
    c.shading.refraction_tint = ShadingConventions::RefractionTint::PerEvent;
    c.shading.ambient_inside_times_kt = false;
    c.shading.clamp_attenuation = false;
    c.shading.air_index = 1.0;
    c.film.linear_output = false;
    c.shading.min_contribution = 1.0 / 512.0;
    c.importing.surroundings = true;
    return c;
}

/// True if the text appears to be a JSON object with a key "asset", from its first bytes and a
/// search for the key.
bool looks_like_json_gltf(std::string_view text) {
    const std::size_t begin = text.find_first_not_of(" \t\r\n");
    if (begin == std::string_view::npos || text[begin] != '{') return false;
    // Covers the whole text: large files may have their buffers in front.
    for (std::size_t at = text.find("\"asset\""); at != std::string_view::npos;
         at = text.find("\"asset\"", at + 1)) {
        const std::size_t next = text.find_first_not_of(" \t\r\n", at + 7);
        if (next != std::string_view::npos && text[next] == ':') return true;
    }
    return false;
}

/// Root nodes of the displayed scene.
std::vector<gltf::Index> shown_nodes(const gltf::Document& document, const ImportSource& source,
                                     Diagnostics& diagnostics) {
    if (document.scene) return document.scenes[*document.scene].nodes;
    if (!document.scenes.empty()) return document.scenes.front().nodes;
    diagnostics.warning({source.path.string(), 0, 0},
                        "the file has no scene; all of its nodes are shown");
    return gltf::root_nodes(document);
}

gltf::Budget budget_of(const gltf::Document& document, const ImportSource& source) {
    std::uint64_t bytes = source.bytes.size();
    for (const gltf::Buffer& buffer : document.buffers) bytes += buffer.bytes.size();
    const ImportOptions& options = source.options;
    return gltf::Budget(options.max_elements,
                        options.max_made_bytes.value_or(gltf::Budget::default_bytes(bytes)));
}

void name_animations(const gltf::Document& document, gltf::Budget& budget,
                     SceneDescription& scene) {
    std::map<gltf::Index, Interval> times;  // shared by samplers
    for (const gltf::Animation& animation : document.animations) {
        Interval all;
        for (const gltf::AnimationSampler& sampler : animation.samplers) {
            const auto [entry, fresh] = times.try_emplace(sampler.input);
            if (fresh) {
                budget.take(document.accessors[sampler.input].count);
                for (const double time : gltf::read_numbers(document, sampler.input)) {
                    entry->second.include(time);
                }
            }
            all.include(entry->second.lo);
            all.include(entry->second.hi);
        }
        const bool timed = all.lo <= all.hi && std::isfinite(all.lo) && std::isfinite(all.hi);
        scene.animations.push_back({animation.name, timed ? all.lo : 0.0, timed ? all.hi : 0.0});
    }
}

}  // namespace

const char* GltfImporter::description() const {
    return "glTF 2.0: .gltf with its files or embedded, and .glb";
}

int GltfImporter::recognise(const ImportSource& source) const {
    if (source.bytes.starts_with("glTF") || looks_like_json_gltf(source.bytes)) return 2;
    const std::string suffix = lower_suffix(source.path);
    return suffix == ".gltf" || suffix == ".glb" ? 1 : 0;
}

SceneDescription GltfImporter::import(const ImportSource& source, Diagnostics& diagnostics) const {
    SceneDescription scene;
    scene.format = name();
    scene.path = source.path;
    scene.conventions = gltf_conventions();
    scene.objects.push_back({"root", {}, {source.path.string(), 0, 0}});
    const gltf::Document document = gltf::read_gltf_document(source, diagnostics);
    if (diagnostics.error_count() > 0) return scene;

    gltf::Budget budget = budget_of(document, source);
    name_animations(document, budget, scene);
    gltf::Pose pose = gltf::rest_pose(document);
    gltf::apply_animations(document, source, pose, budget, diagnostics);
    const std::vector<Affine> world_from_node = gltf::world_transforms(document, pose);
    const std::vector<gltf::Index> nodes =
        gltf::nodes_below(document, shown_nodes(document, source, diagnostics));

    const std::vector<gltf::Index> visible = gltf::visible_nodes(document, nodes);

    gltf::add_materials(document, source, scene, diagnostics);
    gltf::NodeBuilder(document, source, pose, budget, scene, diagnostics)
        .add(visible, world_from_node);
    gltf::add_cameras(document, nodes, world_from_node, scene);
    gltf::add_lights(document, visible, world_from_node, scene);
    return scene;
}

}  // namespace alhazen
