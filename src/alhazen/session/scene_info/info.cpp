#include "alhazen/session/scene_info/info.h"

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>

#include "alhazen/base/overloaded.h"
#include "alhazen/session/masked_parts.h"
#include "alhazen/session/scene_info/mesh_figures.h"
#include "alhazen/session/scene_info/patch_figures.h"
#include "alhazen/session/unique_bytes.h"
#include "alhazen/solids/vector_json.h"
#include "alhazen/verification/exact_bounds.h"

namespace alhazen {

namespace {

using json = nlohmann::ordered_json;

/// Larger meshes are tested for closedness only on request.
constexpr std::size_t kMaxClosedTriangles = 2'000'000;

/// JSON has no infinities: empty and unbounded boxes have no bounds.
json box_json(const Box3& box) {
    if (box.empty() || !box.bounded()) return nullptr;
    return {{"min", vector_json(box.lo)},
            {"max", vector_json(box.hi)},
            {"size", vector_json(box.size())}};
}

/// Number of parts of each kind, each object counted once.
json part_counts(const SceneDescription& description) {
    std::map<std::string, std::size_t> counts;
    for (const ObjectDescription& object : description.objects) {
        for (const Part& part : object.parts) {
            if (const auto* shape = std::get_if<AnyShape>(&part.what)) {
                ++counts[std::visit([](const auto& s) { return std::string(s.kName); }, *shape)];
            } else if (std::holds_alternative<MeshIndex>(part.what)) {
                ++counts["mesh"];
            } else {
                ++counts["instance"];
            }
        }
    }
    return counts;
}

json edges_json(const MeshEdges& edges) {
    json shown = json::array();
    for (const auto& [from, to] : edges.first_open) {
        shown.push_back({vector_json(from), vector_json(to)});
    }
    return {{"count", edges.count},   {"open", edges.open},
            {"turned", edges.turned}, {"of_four_or_more", edges.crowded},
            {"first_open", shown},    {"open_between", box_json(edges.open_box)}};
}

json meshes_json(const SceneDescription& d, const std::vector<MeshFigures>& figures) {
    json meshes = json::array();
    for (std::size_t i = 0; i < figures.size(); ++i) {
        const MeshFigures& f = figures[i];
        json mesh{{"name", d.meshes[i].name},
                  {"triangles", f.triangles},
                  {"vertices", f.vertices},
                  {"unused_vertices", f.unused_vertices},
                  {"area", f.area},
                  {"volume", f.volume},
                  {"closed", f.edges ? json(f.edges->closed()) : json(nullptr)}};
        if (f.edges && f.edges->count > 0) {
            mesh["edges"] = edges_json(*f.edges);
            if (!f.edges->oriented()) mesh["amiss"] = f.edges->description();
        }
        meshes.push_back(std::move(mesh));
    }
    return meshes;
}

/// True if all are closed; null if any is unknown.
json all_closed(const std::vector<MeshFigures>& figures) {
    bool known = !figures.empty();
    for (const MeshFigures& f : figures) {
        if (f.edges && !f.edges->closed()) return false;
        known = known && f.edges.has_value();
    }
    return known ? json(true) : json(nullptr);
}

/// Counts and measures of patches, patch meshes and bilinear patches, each in its own frame.
json patches_json(const SceneDescription& d, bool all) {
    json patches = json::array();
    for (const ObjectDescription& object : d.objects) {
        for (const Part& part : object.parts) {
            const auto* shape = std::get_if<AnyShape>(&part.what);
            if (shape == nullptr) continue;
            const bool few = patch_figures(*shape, false).value_or(PatchFigures{}).patches <=
                             kMaxMeasuredPatches;
            const auto figures = patch_figures(*shape, all || few);
            if (!figures) continue;
            json curves = json::array();
            for (const auto& [from, to] : figures->first_open) {
                curves.push_back({vector_json(from), vector_json(to)});
            }
            const auto known = [](const auto& value) { return value ? json(*value) : json(); };
            patches.push_back({{"name", part.name},
                               {"patches", figures->patches},
                               {"control_points", figures->control_points},
                               {"area", known(figures->area)},
                               {"volume", known(figures->flux_volume)},
                               {"closed", known(figures->closed)},
                               {"open_curves", known(figures->open_curves)},
                               {"first_open", std::move(curves)}});
        }
    }
    return patches;
}

json materials_json(const SceneDescription& d) {
    static constexpr const char* kAlpha[] = {"opaque", "mask", "blend"};
    json materials = json::array();
    for (const MaterialDescription& description : d.materials) {
        const Material& m = description.material;
        const char* kind = m.conductor                   ? "conductor"
                           : m.dielectric                ? "dielectric"
                           : !m.metallic_roughness       ? "whitted"
                           : m.metallic_roughness->unlit ? "unlit"
                                                         : "metallic-roughness";
        materials.push_back({{"name", m.name},
                             {"kind", kind},
                             {"alpha", kAlpha[static_cast<int>(m.alpha_mode)]},
                             {"transparent", !m.is_opaque()},
                             {"double_sided", m.double_sided}});
    }
    return materials;
}

json texture_json(const std::string& name, const SolidTexture& t) {
    static constexpr const char* kKinds[] = {"checks", "stripes", "noise", "marble", "wood"};
    return {{"name", name}, {"solid", kKinds[static_cast<int>(t.kind)]}};
}

json texture_json(const std::string& name, const ImageTexture& t) {
    static constexpr const char* kFilters[] = {"nearest", "bilinear", "mipmapped",
                                               "nearest_mipmapped"};
    static constexpr int kBits[] = {8, 16, 32};
    return {{"name", name},
            {"width", t.image->width},
            {"height", t.image->height},
            {"channels", t.image->channels},
            {"bits", kBits[t.image->samples.index()]},
            {"filter", kFilters[static_cast<int>(t.filter)]},
            {"bytes", t.image->memory_bytes()}};
}

json textures_json(const SceneDescription& d) {
    json textures = json::array();
    for (const TextureDescription& description : d.textures) {
        textures.push_back(std::visit(
            [&](const auto& t) { return texture_json(description.name, t); }, description.texture));
    }
    return textures;
}

json camera_json(const CameraDescription& description) {
    constexpr double kDegrees = 180.0 / std::numbers::pi;
    json camera = {{"name", description.name}};
    std::visit(
        Overloaded{[&](const PerspectiveCamera& c) {
                       const auto field = [&](const Vec3& side) {
                           return 2.0 * kDegrees * std::atan(0.5 * length(side) / length(c.look));
                       };
                       camera["kind"] = "perspective";
                       camera["fov_x_deg"] = field(c.right);
                       camera["fov_y_deg"] = field(c.up);
                       camera["eye"] = vector_json(c.eye);
                   },
                   [&](const OrthographicCamera& c) {
                       camera["kind"] = "orthographic";
                       camera["width"] = length(c.right);
                       camera["height"] = length(c.up);
                       camera["eye"] = vector_json(c.origin);
                   },
                   [&](const WideCamera& c) {
                       static constexpr const char* kKinds[] = {"fisheye", "equisolid", "panorama"};
                       camera["kind"] = kKinds[static_cast<int>(c.projection)];
                       camera["fov_x_deg"] = kDegrees * c.width;
                       camera["fov_y_deg"] = kDegrees * c.height;
                       camera["eye"] = vector_json(c.eye);
                   }},
        description.camera);
    camera["aspect"] = description.aspect;
    return camera;
}

const char* light_kind(const Light& light) {
    return std::visit(Overloaded{[](const AmbientLight&) { return "ambient"; },
                                 [](const DirectionalLight&) { return "directional"; },
                                 [](const PointLight&) { return "point"; },
                                 [](const SpotLight&) { return "spot"; },
                                 [](const AreaLight&) { return "area"; }},
                      light);
}

json memory_json(const LoadedScene& loaded) {
    const SceneCensus& census = loaded.scene.census;
    json memory = {{"geometry_bytes", census.scene_bytes - census.texture_bytes},
                   {"texture_bytes", census.texture_bytes},
                   {"accelerator_bytes", census.accelerator_bytes},
                   {"peak_after_load_bytes", loaded.load_peak_bytes},
                   {"peak_after_build_bytes", loaded.build_peak_bytes}};
    const std::optional<double> effective = bytes_per_effective_primitive(census);
    memory["unique_bytes"] = unique_bytes(census);
    memory["bytes_per_effective_primitive"] = effective ? json(*effective) : json(nullptr);
    if (census.triangles > 0) {
        const auto each = [&](const char* key) {
            return memory[key].get<double>() / static_cast<double>(census.triangles);
        };
        memory["per_triangle"] = {{"geometry", each("geometry_bytes")},
                                  {"accelerator", each("accelerator_bytes")},
                                  {"peak_after_load", each("peak_after_load_bytes")},
                                  {"peak_after_build", each("peak_after_build_bytes")}};
    }
    return memory;
}

void add_geometry(json& info, const LoadedScene& loaded, const InfoOptions& options) {
    const SceneDescription& d = loaded.description;
    const SceneCensus& census = loaded.scene.census;
    std::vector<MeshFigures> figures;
    std::size_t vertices = 0, unused = 0;
    for (const MeshDescription& mesh : d.meshes) {
        const bool look = options.all || mesh.mesh->triangles.size() <= kMaxClosedTriangles;
        figures.push_back(figures_of(*mesh.mesh, look));
        vertices += figures.back().vertices;
        unused += figures.back().unused_vertices;
    }
    // The accelerator's box has margins: it only tells whether the scene is bounded.
    const Box3 box = loaded.scene.aggregate->box();
    const bool unbounded = !box.empty() && !box.bounded();
    const json bounds = box.empty() ? nullptr : box_json(exact_bounds(*loaded.scene.aggregate));
    info["bounds"] = unbounded ? nullptr : bounds;
    info["bounded"] = !unbounded;
    if (unbounded) info["bounded_part"] = bounds;
    info["parts"] = part_counts(d);
    info["masked_parts"] = masked_parts(d);
    info["analytic_shapes"] = census.analytic_shapes;
    info["triangles"] = census.triangles;
    info["vertices"] = vertices;
    info["unused_vertices"] = unused;
    info["instances"] = census.instances;
    info["solids"] = census.solids;
    info["solid_leaves"] = census.solid_leaves;
    info["instance_depth"] = census.instance_depth;
    info["effective_primitives"] = census.effective_primitives;
    const auto placed = placed_figures(d, figures);
    info["mesh_area"] = placed ? json(placed->area) : json(nullptr);
    info["mesh_volume"] = placed ? json(placed->volume) : json(nullptr);
    info["meshes_closed"] = all_closed(figures);
    info["meshes"] = meshes_json(d, figures);
    info["patches"] = patches_json(d, options.all);
}

void add_looks(json& info, const SceneDescription& d) {
    info["materials"] = materials_json(d);
    info["textures"] = textures_json(d);
    info["cameras"] = json::array();
    for (const CameraDescription& camera : d.cameras) {
        info["cameras"].push_back(camera_json(camera));
    }
    info["lights"] = json::array();
    for (const LightDescription& light : d.lights) {
        info["lights"].push_back({{"name", light.name}, {"kind", light_kind(light.light)}});
    }
    if (d.environment) {
        const EnvironmentSettings& e = d.environment->settings;
        info["environment"] = {{"kind", kEnvironmentKindNames[static_cast<std::size_t>(e.kind)]}};
    }
    info["animations"] = json::array();
    for (const AnimationInfo& animation : d.animations) {
        info["animations"].push_back(
            {{"name", animation.name}, {"begin", animation.begin}, {"end", animation.end}});
    }
    if (d.picture.width) info["picture"]["width"] = *d.picture.width;
    if (d.picture.height) info["picture"]["height"] = *d.picture.height;
    info["max_depth"] = d.conventions.shading.max_depth;
}

}  // namespace

json scene_info(const std::string& scene_name, const LoadedScene& loaded,
                const InfoOptions& options) {
    json info = {{"scene", scene_name}, {"format", loaded.description.format}};
    std::error_code failed;
    const std::uintmax_t bytes = std::filesystem::file_size(scene_name, failed);
    info["file_bytes"] = failed ? json(nullptr) : json(bytes);
    add_geometry(info, loaded, options);
    add_looks(info, loaded.description);
    info["accelerator"] = loaded.scene.accelerator;
    info["memory"] = memory_json(loaded);
    info["seconds"] = {{"load", loaded.load_seconds}, {"build", loaded.build_seconds}};
    info["warnings"] = json::array();
    for (const Diagnostic& diagnostic : loaded.diagnostics.all()) {
        info["warnings"].push_back(to_string(diagnostic));
    }
    return info;
}

}  // namespace alhazen
