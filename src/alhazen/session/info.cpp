#include "alhazen/session/info.h"

#include <fmt/format.h>

#include <map>
#include <nlohmann/json.hpp>

namespace alhazen {

namespace {

using json = nlohmann::ordered_json;

json vector_json(const Vec3& v) {
    return json::array({v.x, v.y, v.z});
}

const char* light_kind(const Light& light) {
    static constexpr const char* kNames[] = {"ambient", "directional", "point", "spot"};
    static_assert(std::size(kNames) == std::variant_size_v<Light>);
    return kNames[light.index()];
}

/// How many parts of each kind the description has, each object counted once.
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

}  // namespace

json scene_info(const std::string& scene_name, const LoadedScene& loaded) {
    const SceneDescription& d = loaded.description;
    const SceneCensus& census = loaded.scene.census;
    json cameras = json::array();
    for (const CameraDescription& camera : d.cameras) {
        const bool perspective = std::holds_alternative<PerspectiveCamera>(camera.camera);
        cameras.push_back({{"name", camera.name},
                           {"kind", perspective ? "perspective" : "orthographic"},
                           {"aspect", camera.aspect}});
    }
    std::map<std::string, std::size_t> lights;
    for (const LightDescription& light : d.lights) ++lights[light_kind(light.light)];
    json warnings = json::array();
    for (const Diagnostic& diagnostic : loaded.diagnostics.all()) {
        warnings.push_back(to_string(diagnostic));
    }
    const Box3 box = loaded.scene.aggregate->box();
    json bounds = nullptr;  // JSON has no infinities: unbounded and empty scenes have no bounds
    if (!box.empty() && box.bounded())
        bounds = {{"min", vector_json(box.lo)}, {"max", vector_json(box.hi)}};
    json result = {
        {"scene", scene_name},
        {"format", d.format},
        {"bounds", bounds},
        {"bounded", box.empty() || box.bounded()},
        {"parts", part_counts(d)},
        {"analytic_shapes", census.analytic_shapes},
        {"triangles", census.triangles},
        {"instances", census.instances},
        {"instance_depth", census.instance_depth},
        {"effective_primitives", census.effective_primitives},
        {"cameras", cameras},
        {"lights", lights},
        {"materials", d.materials.size()},
        {"textures", d.textures.size()},
        {"scene_bytes", census.scene_bytes},
        {"accelerator", loaded.scene.accelerator},
        {"accelerator_bytes", census.accelerator_bytes},
        {"seconds", {{"load", loaded.load_seconds}, {"build", loaded.build_seconds}}},
        {"warnings", warnings},
    };
    if (d.picture.width) result["picture"]["width"] = *d.picture.width;
    if (d.picture.height) result["picture"]["height"] = *d.picture.height;
    result["max_depth"] = d.conventions.max_depth;
    return result;
}

std::string info_text(const json& info) {
    std::string text;
    for (const auto& [key, value] : info.items()) {
        if (value.is_object()) {
            text += fmt::format("{:<22}", key);
            const char* separator = "";
            for (const auto& [name, inner] : value.items()) {
                text += fmt::format("{}{} {}", separator, name, inner.dump());
                separator = ", ";
            }
            if (value.empty()) text += "none";
        } else if (value.is_array() && !value.empty()) {
            text += fmt::format("{:<22}{}", key, value.size());
            for (const auto& inner : value) {
                text += "\n    " + (inner.is_string() ? inner.get<std::string>() : inner.dump());
            }
        } else if (value.is_array()) {
            text += fmt::format("{:<22}none", key);
        } else {
            text += fmt::format("{:<22}{}", key,
                                value.is_string() ? value.get<std::string>() : value.dump());
        }
        text += '\n';
    }
    return text;
}

}  // namespace alhazen
