#include "alhazen/session/lighting.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <unordered_map>
#include <unordered_set>

#include "alhazen/base/error.h"
#include "alhazen/session/seen_lights.h"

namespace alhazen {

namespace {

constexpr const char* kLightKinds[] = {"ambient light", "directional light", "point light",
                                       "spot light", "area light"};
static_assert(std::size(kLightKinds) == std::variant_size_v<Light>);

bool emits(const Material& material) {
    if (material.metallic_roughness && material.metallic_roughness->unlit) return false;
    return !material.emission.color.is_black();
}

void turn_off(Material& material) {
    material.emission = {};
    material.illuminant.reset();
}

/// What a choice stands for.
struct Switch {
    LightChoice choice;
    std::optional<std::size_t> light;
    std::optional<MaterialId> material;
};

std::vector<Switch> switches(const SceneDescription& description) {
    std::vector<Switch> list;
    std::set<MaterialId> of_lights;
    for (std::size_t i = 0; i < description.lights.size(); ++i) {
        const char* const kind = kLightKinds[description.lights[i].light.index()];
        const std::optional<MaterialId> material = material_of_light(description, i);
        if (material) of_lights.insert(*material);
        list.push_back({{light_name(description, i), kind}, i, material});
    }
    for (std::size_t i = 0; i < description.materials.size(); ++i) {
        const Material& material = description.materials[i].material;
        const auto id = static_cast<MaterialId>(i);
        if (!emits(material) || of_lights.contains(id)) continue;
        list.push_back({{material.name.empty() ? fmt::format("material {}", i + 1) : material.name,
                         "material that emits"},
                        {},
                        id});
    }
    std::unordered_set<std::string> names;
    std::unordered_map<std::string, std::size_t> next;  // all numbers below are taken
    for (Switch& s : list) {
        if (names.insert(s.choice.name).second) continue;
        std::size_t& n = next.try_emplace(s.choice.name, 2).first->second;
        const std::string given = std::move(s.choice.name);
        do {
            s.choice.name = fmt::format("{} ({})", given, n++);
        } while (!names.insert(s.choice.name).second);
    }
    return list;
}

}  // namespace

std::string light_name(const SceneDescription& description, std::size_t light) {
    const LightDescription& described = description.lights[light];
    if (!described.name.empty()) return described.name;
    return fmt::format("{} {}", kLightKinds[described.light.index()], light + 1);
}

std::vector<LightChoice> light_choices(const SceneDescription& description) {
    std::vector<LightChoice> list;
    for (Switch& s : switches(description)) list.push_back(std::move(s.choice));
    return list;
}

Scene with_lighting(const Scene& scene, const SceneDescription& description,
                    const Lighting& lighting) {
    Scene result = scene;
    if (!lighting.off.empty()) {
        const std::vector<Switch> all = switches(description);
        for (const std::string& name : lighting.off) {
            const auto found = std::find_if(all.begin(), all.end(),
                                            [&](const Switch& s) { return s.choice.name == name; });
            if (found == all.end()) {
                std::string known;
                for (const Switch& s : all) known += (known.empty() ? "" : ", ") + s.choice.name;
                throw Error(ErrorKind::Usage,
                            fmt::format("there is no light '{}'; expected one of: {}", name,
                                        known.empty() ? "none" : known));
            }
            if (found->light) result.lights[*found->light] = AmbientLight{};
            if (found->material) {
                turn_off(result.materials[static_cast<std::size_t>(*found->material)]);
            }
        }
    }
    if (lighting.environment.empty()) return result;
    result.environment = lighting.surroundings;
    if (lighting.environment == "none") result.background = {};
    return result;
}

}  // namespace alhazen
