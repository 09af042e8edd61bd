#include "alhazen/formats/brlcad/brlcad_materials.h"

#include <algorithm>
#include <utility>

namespace alhazen {

namespace {

/// Parameters of the shaders' Phong model with their defaults.
struct Phong {
    double shine = 10, specular = 0.7, diffuse = 0.3;
    double transmit = 0, reflect = 0, index = 1;
    Rgb emission;
};

std::optional<Phong> preset(const std::string& name) {
    if (name.empty() || name == "plastic" || name == "default" || name == "phong") return Phong{};
    if (name == "mirror") return Phong{4, 0.6, 0.4, 0, 0.75, 1.65, {}};
    if (name == "glass") return Phong{4, 0.7, 0.3, 0.8, 0.1, 1.65, {}};
    return std::nullopt;
}

void apply(const BrlcadShader& text, Phong& phong) {
    const auto take = [&](double& value, const char* long_name, const char* short_name) {
        if (const auto given = text.number(long_name, short_name)) {
            value = std::clamp(*given, 0.0, 1e6);
        }
    };
    take(phong.shine, "shine", "sh");
    take(phong.specular, "specular", "sp");
    take(phong.diffuse, "diffuse", "di");
    take(phong.transmit, "transmit", "tr");
    take(phong.reflect, "reflect", "re");
    take(phong.index, "ri", "refraction");
    if (const auto given = text.three("emission", "em")) {
        phong.emission = *given;
    } else if (const auto grey_emission = text.number("emission", "em")) {
        phong.emission = {*grey_emission, *grey_emission, *grey_emission};
    }
    for (int c = 0; c < 3; ++c) phong.emission[c] = std::clamp(phong.emission[c], 0.0, 1e6);
    phong.transmit = std::min(phong.transmit, 1.0);
    phong.reflect = std::min(phong.reflect, 1.0 - phong.transmit);
    if (!(phong.index > 0.0)) phong.index = 1.0;
}

}  // namespace

BrlcadState BrlcadState::below(const BrlcadCombination& comb) const {
    BrlcadState state = *this;
    if (comb.color && !color_fixed) {
        state.color = comb.color;
        state.color_fixed = comb.inherit;
    }
    if (!comb.shader.empty() && !shader_fixed) {
        state.shader = comb.shader;
        state.shader_fixed = comb.inherit;
    }
    return state;
}

namespace {

constexpr std::string_view kPhongParameters[] = {
    "shine", "sh",      "specular", "sp", "diffuse",    "di",       "transmit",
    "tr",    "reflect", "re",       "ri", "refraction", "emission", "em"};
constexpr std::string_view kLightParameters[] = {
    "bright", "b",       "inten", "angle",    "a", "fract",   "f", "target",   "t",
    "aim",    "shadows", "s",     "infinite", "i", "visible", "v", "invisible"};
constexpr std::string_view kPatternParameters[] = {"a", "b", "s", "thresh", "range"};

BrlcadLight light_of(const BrlcadShader& shader, const Rgb& color) {
    BrlcadLight light;
    light.color = color;
    const auto intensity = shader.number("bright", "b");
    light.intensity = intensity ? *intensity : shader.number("inten").value_or(1.0);
    if (!(light.intensity > 0.0)) light.intensity = 1.0;
    light.fraction = shader.number("fract", "f").value_or(-1.0);
    light.angle_deg = std::clamp(shader.number("angle", "a").value_or(180.0), 0.0, 180.0);
    light.infinite = shader.number("infinite", "i").value_or(0.0) != 0.0;
    light.shown = shader.number("visible", "v").value_or(1.0) != 0.0 &&
                  shader.number("invisible").value_or(0.0) == 0.0;
    auto target = shader.three("target", "t");
    if (!target) target = shader.three("aim");
    if (target) light.target = Vec3{target->r, target->g, target->b};
    return light;
}

/// The colour of a region and its patterns.
struct Base {
    Rgb color;
    TextureId texture = kNoTexture;

    [[nodiscard]] ColorInput times(double factor) const { return {factor * color, texture}; }
};

Material phong_material(const Phong& phong, const Base& base) {
    const double rest = 1.0 - phong.transmit - phong.reflect;
    Material material;
    material.ambient = base.times(rest);
    material.diffuse = base.times(rest * phong.diffuse);
    material.specular.color = grey(rest * phong.specular);
    material.shininess.value = phong.shine;
    material.reflective.color = grey(phong.reflect);
    material.transmissive = base.times(phong.transmit);
    material.index.value = phong.index;
    material.emission.color = rest * phong.emission;
    return material;
}

}  // namespace

void BrlcadMaterials::tell_once(const std::string& message, const BrlcadPlace& place) {
    if (reported_.insert(message).second) diagnostics_.warning(database_.at(place), message);
}

void BrlcadMaterials::tell_unknown(const BrlcadShader& shader,
                                   std::span<const std::string_view> known,
                                   const BrlcadPlace& place) {
    for (const auto& [name, values] : shader.parameters) {
        if (std::find(known.begin(), known.end(), name) != known.end()) continue;
        tell_once("the option '" + name.substr(0, 40) + "' of the shader '" +
                      shader.name.substr(0, 40) + "' is not read",
                  place);
    }
}

TextureId BrlcadMaterials::texture_of(BrlcadPattern pattern, const Vec2& unit,
                                      const BrlcadPlace& place) {
    ImageTexture texture;
    texture.filter = pattern.smooth ? TextureFilter::Bilinear : TextureFilter::Nearest;
    texture.image = std::make_shared<const StoredImage>(stored(std::move(pattern.image)));
    texture.uv_transform.uu = pattern.repeats / unit.x;
    texture.uv_transform.vv = pattern.repeats / unit.y;
    scene_.textures.push_back({"pattern " + std::to_string(scene_.textures.size() + 1),
                               std::move(texture), database_.at(place)});
    return static_cast<TextureId>(scene_.textures.size() - 1);
}

Material BrlcadMaterials::make(const std::vector<BrlcadShader>& shaders, const Rgb& color,
                               const Vec2& unit, const BrlcadPlace& place,
                               std::optional<BrlcadLight>& light) {
    Base base{color};
    std::optional<Phong> phong;
    for (const BrlcadShader& shader : shaders) {
        if (shader.name == "stack" || shader.name == "envmap") continue;
        if (shader.name == "light") {
            tell_unknown(shader, kLightParameters, place);
            if (shader.number("shadows", "s").value_or(1.0) == 0.0) {
                tell_once("lights without shadows are not supported: this one casts shadows",
                          place);
            }
            if (shader.number("shadows", "s").value_or(1.0) > 1.0) {
                tell_once(
                    "soft shadows are not supported: the light is a point light at its centre",
                    place);
            }
            light = light_of(shader, color);
            // Invisible, and transparent to its own light. add_brlcad_lights sets its brightness if
            // it is visible.
            Material material;
            material.transmissive.color = {1, 1, 1};
            return material;
        }
        if (auto pattern = brlcad_pattern(shader)) {
            tell_unknown(shader, kPatternParameters, place);
            base = {{1, 1, 1}, texture_of(*std::move(pattern), unit, place)};
            continue;
        }
        phong = preset(shader.name);
        if (!phong) {
            tell_once(
                "the shader '" + shader.name.substr(0, 40) + "' is not supported; shown as plastic",
                place);
            phong = Phong{};
        } else {
            tell_unknown(shader, kPhongParameters, place);
        }
        apply(shader, *phong);
    }
    if (phong || base.texture == kNoTexture) return phong_material(phong.value_or(Phong{}), base);
    // A pattern alone emits its colours, independent of lights.
    Material material;
    material.emission = base.times(1.0);
    return material;
}

Rgb BrlcadMaterials::color_of(const BrlcadState& state, int region_id) const {
    if (state.color) return *state.color;
    // A later entry replaces what it covers of earlier ones.
    const auto& table = database_.region_colors;
    const auto entry = std::find_if(table.rbegin(), table.rend(), [&](const auto& one) {
        return one.first <= region_id && region_id <= one.last;
    });
    if (entry != table.rend()) return entry->color;
    return {1, 1, 1};
}

bool BrlcadMaterials::takes_environment(const BrlcadState& state, int region_id,
                                        const BrlcadPlace& place) {
    const std::vector<BrlcadShader> shaders = read_brlcad_shaders(state.shader);
    if (shaders.empty() || shaders[0].name != "envmap") return false;
    if (std::exchange(has_environment_, true)) {
        tell_once("a second envmap is left out", place);
        return true;
    }
    Rgb background = color_of(state, region_id);
    for (std::size_t i = 1; i < shaders.size(); ++i) {
        if (const auto pattern = brlcad_pattern(shaders[i])) {
            background = pattern->mean;
            tell_once("the environment is shown in the mean colour of '" + shaders[i].name + "'",
                      place);
        } else if (shaders[i].name != "stack" && !preset(shaders[i].name)) {
            tell_once("the environment '" + shaders[i].name.substr(0, 40) +
                          "' is not supported; shown in the region's colour",
                      place);
        }
    }
    scene_.picture.background = background;
    return true;
}

MaterialId BrlcadMaterials::of(const BrlcadState& state, int region_id, const Vec2& unit,
                               const BrlcadPlace& place) {
    const Rgb color = color_of(state, region_id);
    const std::vector<BrlcadShader> shaders = read_brlcad_shaders(state.shader);
    const bool patterned = std::any_of(shaders.begin(), shaders.end(), [](const BrlcadShader& one) {
        return brlcad_pattern(one).has_value();
    });
    const Vec2 repeats = patterned ? unit : Vec2{1, 1};
    const auto [known, fresh] = known_.try_emplace(
        std::make_tuple(color.r, color.g, color.b, state.shader, repeats.x, repeats.y),
        MaterialId(known_.size()));
    if (!fresh) return known->second;
    std::optional<BrlcadLight> light;
    Material material = make(shaders, color, repeats, place, light);
    material.name = (shaders.empty() ? std::string("plastic") : shaders[0].name.substr(0, 40)) +
                    " " + std::to_string(known_.size());
    if (light) lights_.emplace(known->second, *light);
    scene_.materials.push_back({std::move(material), database_.at(place)});
    return known->second;
}

}  // namespace alhazen
