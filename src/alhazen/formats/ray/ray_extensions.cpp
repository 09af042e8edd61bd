#include "alhazen/formats/ray/ray_extensions.h"

#include <algorithm>
#include <array>

namespace alhazen {

namespace {

struct Extension {
    std::string_view name;
    std::string_view meaning;
    bool dictionary_only = true;
};

constexpr std::array kObjectsAndLights{
    Extension{"csg", "constructive solid geometry, HKUST"},
    Extension{"intersection", "constructive solid geometry, HKUST"},
    Extension{"subtraction", "constructive solid geometry, HKUST"},
    Extension{"union", "constructive solid geometry, HKUST"},
    Extension{"hyperbolic", "hyperbolic paraboloids, HKUST"},
    Extension{"paraboloid", "paraboloids, HKUST"},
    Extension{"metaball", "metaballs, HKUST"},
    Extension{"metaballs", "metaballs, HKUST"},
    Extension{"torus", "tori, HKUST and UT Austin students", false},
    Extension{"torus_knot", "torus knots, HKUST"},
    Extension{"moving_sphere", "motion blur, HKUST"},
    Extension{"particles", "particle systems, HKUST"},
    Extension{"meteorite", "particle systems, HKUST"},
    Extension{"fluid", "fluids, HKUST"},
    Extension{"quadric", "unbounded quadrics, UT Austin students", false},
    Extension{"objfile", "OBJ files, UT Austin students", false},
    Extension{"objgroup", "OBJ files, UT Austin students", false},
    Extension{"shape_light", "lights cut to a shape, HKUST"},
    Extension{"warn_light", "Warn's light controls, HKUST"},
    Extension{"sphere_light", "spherical lights, HKUST"},
    Extension{"skybox", "environment maps, HKUST"},
};

constexpr std::array kMaterialKeys{
    Extension{"type", "microfacet and Disney materials, HKUST"},
    Extension{"roughness", "microfacet materials, HKUST"},
    Extension{"metallic", "Disney materials, HKUST"},
    Extension{"absorb", "absorption by length, HKUST"},
    Extension{"glossiness", "glossy reflection, HKUST"},
    Extension{"glossy", "glossy reflection, students"},
    Extension{"normal", "normal maps, HKUST"},
    Extension{"normal_map", "normal maps, HKUST"},
    Extension{"diffuse_map", "diffuse maps beside a colour, HKUST"},
    Extension{"bump", "bump maps, HKUST"},
    Extension{"bump_map", "bump maps, HKUST"},
    Extension{"marble", "solid textures, HKUST"},
};

template <class Table>
const Extension* lookup(const Table& table, std::string_view name) {
    const auto found = std::find_if(table.begin(), table.end(),
                                    [&](const Extension& e) { return e.name == name; });
    return found == table.end() ? nullptr : &*found;
}

}  // namespace

std::optional<std::string_view> ray_extension(std::string_view name) {
    const Extension* found = lookup(kObjectsAndLights, name);
    if (found == nullptr) return std::nullopt;
    return found->meaning;
}

std::optional<std::string_view> ray_material_extension(std::string_view key) {
    const Extension* found = lookup(kMaterialKeys, key);
    if (found == nullptr) return std::nullopt;
    return found->meaning;
}

bool is_dictionary_extension(std::string_view name) {
    if (name == "spot_light") return true;
    const Extension* found = lookup(kObjectsAndLights, name);
    return found != nullptr && found->dictionary_only;
}

std::string refusal(std::string_view kind, std::string_view name, std::string_view extension) {
    return std::string(kind) + " '" + std::string(name) +
           "' belongs to an extension of the format (" + std::string(extension) +
           ") that is not supported";
}

}  // namespace alhazen
