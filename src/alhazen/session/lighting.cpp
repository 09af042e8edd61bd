#include "alhazen/session/lighting.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <unordered_map>
#include <unordered_set>

#include "alhazen/base/control_characters.h"
#include "alhazen/base/error.h"
#include "alhazen/base/overloaded.h"
#include "alhazen/formats/native/write/native_writer.h"
#include "alhazen/session/seen_lights.h"
#include "alhazen/shading/lights/direction_picture.h"
#include "alhazen/shapes/core/shape_numerics.h"

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

/// Sets position, direction and colour of the choice.
void describe(const Light& light, NamedLight& choice) {
    std::visit(Overloaded{[&](const AmbientLight& l) { choice.color = l.ambient; },
                          [&](const DirectionalLight& l) {
                              choice.direction = Vec3{} - l.to_light;
                              choice.color = l.color;
                          },
                          [&](const PointLight& l) {
                              choice.position = l.position;
                              choice.color = l.color;
                          },
                          [&](const SpotLight& l) {
                              choice.position = l.position;
                              choice.direction = l.direction;
                              choice.color = l.color;
                          },
                          [&](const AreaLight& l) {
                              ExtentHandles handles = handles_of(l.extent);
                              choice.position = handles.position;
                              choice.direction = handles.direction;
                              choice.sizes = std::move(handles.sizes);
                              choice.color = l.radiance;
                          }},
               light);
}

/// Throws if a light is changed twice: changes are relative to the file and would not add up.
void check_names(const std::vector<LightChange>& changes) {
    std::unordered_set<std::string> names;
    for (const LightChange& change : changes) {
        if (names.insert(change.name).second) continue;
        throw Error(ErrorKind::Usage,
                    fmt::format("the light '{}' is changed more than once", change.name));
    }
}

void check(const LightChange& change, const NamedLight& choice) {
    const auto refuse = [&](const std::string& what) {
        throw Error(ErrorKind::Usage, fmt::format("the light '{}' {}", change.name, what));
    };
    if (change.position && !choice.position) refuse("has no position");
    if (change.direction && !choice.direction) refuse("has no direction");
    const auto fits = [](const Vec3& v) {
        return is_finite(v) && max_component(abs(v)) <= kMaxCoordinate;
    };
    if (change.position && !fits(*change.position)) {
        refuse("must be at three finite numbers below 1e70");
    }
    if (change.direction && !(fits(*change.direction) && length_squared(*change.direction) > 0)) {
        refuse("must have a direction of three finite numbers, one of which is not 0");
    }
    if (!change.sizes.empty()) {
        if (change.sizes.size() != choice.sizes.size()) {
            refuse(fmt::format("has {} sizes, found {}", choice.sizes.size(), change.sizes.size()));
        }
        const bool good = std::all_of(change.sizes.begin(), change.sizes.end(),
                                      [](double x) { return x >= 0.0 && x <= kMaxCoordinate; });
        if (!good) refuse("must have sizes of 0 to 1e70");
    }
    if (!change.color) return;
    for (int i = 0; i < 3; ++i) {
        const double c = (*change.color)[i];
        if (!(c >= 0.0 && c <= kLargestRadiance)) refuse("must have a colour of 0 to 1e15");
    }
}

void apply(const LightChange& change, Light& light) {
    std::visit(
        [&]<class L>(L& l) {
            if constexpr (requires { l.position; }) {
                if (change.position) l.position = *change.position;
            }
            if constexpr (std::is_same_v<L, DirectionalLight>) {
                if (change.direction) l.to_light = Vec3{} - *change.direction;
            } else if constexpr (requires { l.direction; }) {
                if (change.direction) {
                    // The profile of a spot hangs along its axis unless the file says otherwise.
                    if (l.profile.down == l.direction) l.profile.down = *change.direction;
                    l.direction = *change.direction;
                }
            }
            if constexpr (std::is_same_v<L, AreaLight>) {
                const ExtentChange of_surface{change.position, change.direction, change.sizes};
                if (of_surface.changes_something()) l.extent = changed(l.extent, of_surface);
                if (const char* const fault = fault_of(l.extent)) {
                    throw Error(ErrorKind::Usage,
                                fmt::format("the light '{}': {}", change.name, fault));
                }
            }
            if (!change.color) return;
            if constexpr (std::is_same_v<L, AmbientLight>) {
                l.ambient = *change.color;
            } else if constexpr (std::is_same_v<L, AreaLight>) {
                l.radiance = *change.color;
            } else {
                l.color = *change.color;
            }
        },
        light);
}

void apply(const LightChange& change, Material& material) {
    if (!change.color) return;
    material.emission.color = *change.color;
    material.illuminant.reset();
}

/// The light or material that a choice switches.
struct Switch {
    NamedLight choice;
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
        NamedLight choice{.name = light_name(description, i), .kind = kind};
        describe(description.lights[i].light, choice);
        list.push_back({std::move(choice), i, material});
    }
    for (std::size_t i = 0; i < description.materials.size(); ++i) {
        const Material& material = description.materials[i].material;
        const auto id = static_cast<MaterialId>(i);
        if (!emits(material) || of_lights.contains(id)) continue;
        NamedLight choice{
            .name = material.name.empty() ? fmt::format("material {}", i + 1) : material.name,
            .kind = "material that emits",
            .color = material.emission.color};
        list.push_back({std::move(choice), {}, id});
    }
    std::unordered_set<std::string> names;
    std::unordered_map<std::string, std::size_t> next;  // smaller numbers are taken
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

const Switch& find(const std::vector<Switch>& all, const std::string& name) {
    for (const Switch& s : all) {
        if (s.choice.name == name) return s;
    }
    std::string known;
    for (const Switch& s : all) known += (known.empty() ? "" : ", ") + s.choice.name;
    throw Error(ErrorKind::Usage, fmt::format("there is no light '{}'; expected one of: {}", name,
                                              known.empty() ? "none" : known));
}

}  // namespace

std::string light_name(const SceneDescription& description, std::size_t light) {
    const LightDescription& described = description.lights[light];
    if (!described.name.empty()) return described.name;
    return fmt::format("{} {}", kLightKinds[described.light.index()], light + 1);
}

std::vector<NamedLight> light_choices(const SceneDescription& description) {
    std::vector<NamedLight> list;
    for (Switch& s : switches(description)) list.push_back(std::move(s.choice));
    return list;
}

std::vector<LightChange> surface_changes(const SceneDescription& description,
                                         const std::vector<LightChange>& changes) {
    std::vector<LightChange> result;
    if (changes.empty()) return result;
    check_names(changes);
    const std::vector<Switch> all = switches(description);
    for (const LightChange& change : changes) {
        const Switch& s = find(all, change.name);
        check(change, s.choice);
        if (!s.light || !s.material) continue;
        Light light = description.lights[*s.light].light;
        const LightExtent before = std::get<AreaLight>(light).extent;
        apply(change, light);
        if (std::get<AreaLight>(light).extent == before) continue;
        result.push_back(change);
        result.back().color.reset();
    }
    return result;
}

LoadedScene with_moved_surfaces(const LoadedScene& loaded, const std::vector<LightChange>& changes,
                                const CompileOptions& options) {
    LoadedScene moved;
    moved.description = loaded.description;
    const std::vector<Switch> all = switches(loaded.description);
    for (const LightChange& change : surface_changes(loaded.description, changes)) {
        const std::size_t light = *find(all, change.name).light;
        Light& described = moved.description.lights[light].light;
        apply(change, described);
        set_surface_of_light(moved.description, light, std::get<AreaLight>(described).extent);
    }
    moved.scene = loaded.scene;
    moved.scene.aggregate = nullptr;
    build_aggregate(moved.description, options, moved.scene);
    return moved;
}

Scene with_lighting(const Scene& scene, const SceneDescription& description,
                    const Lighting& lighting) {
    check_names(lighting.changes);
    Scene result = scene;
    const std::vector<Switch> all = switches(description);
    const auto material_of = [&](const Switch& s) -> Material& {
        return result.materials[static_cast<std::size_t>(*s.material)];
    };
    for (const LightChange& change : lighting.changes) {
        const Switch& s = find(all, change.name);
        check(change, s.choice);
        if (s.light) {
            Light light = description.lights[*s.light].light;
            apply(change, light);
            result.lights[*s.light] = ready_to_sample(light);
        }
        if (s.material) apply(change, material_of(s));
    }
    for (const std::string& name : lighting.off) {
        const Switch& s = find(all, name);
        if (s.light) result.lights[*s.light] = AmbientLight{};
        if (s.material) turn_off(material_of(s));
    }
    if (lighting.environment.empty()) return result;
    result.environment = lighting.surroundings;
    if (lighting.environment == "none") result.background = {};
    return result;
}

std::string changed_light_blocks(const SceneDescription& description,
                                 const std::vector<LightChange>& changes) {
    check_names(changes);
    const std::vector<Switch> all = switches(description);
    std::string text;
    for (const LightChange& change : changes) {
        const Switch& s = find(all, change.name);
        check(change, s.choice);
        if (!s.light) {
            const Rgb c = change.color.value_or(s.choice.color);
            text += fmt::format("// material \"{}\": emission = ({}, {}, {})\n",
                                escape_controls(change.name), c.r, c.g, c.b);
            continue;
        }
        LightDescription light = description.lights[*s.light];
        apply(change, light.light);
        if (auto* area = std::get_if<AreaLight>(&light.light)) area->seen |= area->is_part;
        text += native_light_text(light);
    }
    return text;
}

}  // namespace alhazen
