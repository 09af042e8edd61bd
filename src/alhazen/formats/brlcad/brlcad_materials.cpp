#include "alhazen/formats/brlcad/brlcad_materials.h"

#include <algorithm>
#include <array>

#include "alhazen/formats/brlcad/brlcad_tcl.h"
#include "alhazen/formats/text/text_cursor.h"

namespace alhazen {

namespace {

/// Parameters of the shaders' Phong model with their defaults.
struct Phong {
    double shine = 10, specular = 0.7, diffuse = 0.3;
    double transmit = 0, reflect = 0, index = 1, emission = 0;
};

/// A shader's name and its parameters in text order, parsed from "a=1 b=2" or {a 1 b 2}.
struct ShaderText {
    std::string name;
    std::vector<std::pair<std::string, std::string>> parameters;

    [[nodiscard]] std::optional<double> number(std::string_view long_name,
                                               std::string_view short_name) const {
        for (const auto& [key, value] : parameters) {
            if (key != long_name && key != short_name) continue;
            TextCursor cursor(value);
            double number = 0.0;
            if (cursor.number(number)) return number;
        }
        return std::nullopt;
    }
};

ShaderText parse(const std::string& text) {
    ShaderText shader;
    // An '=' between words is optional.
    std::vector<std::string> words;
    TclTokens tokens(text);
    for (TclToken token = tokens.next(); token.kind != TclTokenKind::End; token = tokens.next()) {
        if (token.kind != TclTokenKind::Word) continue;
        std::string_view word = token.word.text;
        // Only the first shader of a stack is used.
        if (words.empty() && (word == "stack" || word == "envmap")) {
            if (word == "envmap") return {"envmap", {}};
            continue;
        }
        const bool assigns = !words.empty();
        const std::size_t equals = assigns ? word.find('=') : std::string_view::npos;
        words.emplace_back(word.substr(0, equals));
        if (equals != std::string_view::npos) words.emplace_back(word.substr(equals + 1));
    }
    if (words.empty()) return shader;
    shader.name = words[0].substr(0, words[0].find(';'));
    for (std::size_t i = 1; i + 1 < words.size(); i += 2) {
        shader.parameters.emplace_back(words[i], words[i + 1]);
    }
    return shader;
}

std::optional<Phong> preset(const std::string& name) {
    if (name.empty() || name == "plastic" || name == "default" || name == "phong") return Phong{};
    if (name == "mirror") return Phong{4, 0.6, 0.4, 0, 0.75, 1.65, 0};
    if (name == "glass") return Phong{4, 0.7, 0.3, 0.8, 0.1, 1.65, 0};
    return std::nullopt;
}

void apply(const ShaderText& text, Phong& phong) {
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
    take(phong.emission, "emission", "em");
    phong.transmit = std::min(phong.transmit, 1.0);
    phong.reflect = std::min(phong.reflect, 1.0 - phong.transmit);
    if (!(phong.index > 0.0)) phong.index = 1.0;
}

Rgb grey(double value) {
    return {value, value, value};
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

Material BrlcadMaterials::make(const std::string& shader, const Rgb& color,
                               const BrlcadPlace& place, std::optional<BrlcadLight>& light) {
    const ShaderText text = parse(shader);
    Material material;
    if (text.name == "light") {
        light.emplace();
        light->color = color;
        light->intensity = std::max(0.0, text.number("fract", "f").value_or(1.0));
        light->shown = text.number("visible", "v").value_or(1.0) != 0.0 &&
                       text.number("invisible", "").value_or(0.0) == 0.0;
        light->infinite = text.number("infinite", "").value_or(0.0) != 0.0;
        // Transparent to its own light, whose source is inside.
        if (light->shown) material.emission.color = color;
        material.transmissive.color = {1, 1, 1};
        return material;
    }
    std::optional<Phong> phong = preset(text.name);
    if (!phong) {
        if (told_.insert(text.name).second) {
            diagnostics_.warning(database_.at(place), "the shader '" + text.name.substr(0, 40) +
                                                          "' is not supported; shown as plastic");
        }
        phong = Phong{};
    }
    apply(text, *phong);
    const double rest = 1.0 - phong->transmit - phong->reflect;
    material.ambient.color = rest * color;
    material.diffuse.color = rest * phong->diffuse * color;
    material.specular.color = grey(rest * phong->specular);
    material.shininess.value = phong->shine;
    material.reflective.color = grey(phong->reflect);
    material.transmissive.color = phong->transmit * color;
    material.index.value = phong->index;
    material.emission.color = phong->emission * color;
    return material;
}

MaterialId BrlcadMaterials::of(const BrlcadState& state, int region_id, const BrlcadPlace& place) {
    Rgb color = state.color.value_or(Rgb{1, 1, 1});
    for (const BrlcadRegionColor& entry : database_.region_colors) {
        if (region_id != 0 && entry.first <= region_id && region_id <= entry.last) {
            color = entry.color;
            break;
        }
    }
    const auto [known, fresh] = known_.try_emplace(
        std::make_tuple(color.r, color.g, color.b, state.shader), MaterialId(known_.size()));
    if (!fresh) return known->second;
    std::optional<BrlcadLight> light;
    Material material = make(state.shader, color, place, light);
    const TclToken first = TclTokens(state.shader).next();
    material.name = (state.shader.empty() ? "plastic" : tcl_value(first.word)) + " " +
                    std::to_string(known_.size());
    if (light) lights_.emplace(known->second, *light);
    scene_.materials.push_back({std::move(material), database_.at(place)});
    return known->second;
}

}  // namespace alhazen
