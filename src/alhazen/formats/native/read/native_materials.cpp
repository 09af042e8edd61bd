#include "alhazen/formats/native/read/native_materials.h"

#include <array>
#include <cmath>

#include "alhazen/formats/native/native_words.h"
#include "alhazen/shading/optics/metals.h"
#include "alhazen/shading/spectrum/illuminant_spectrum.h"

namespace alhazen {

namespace {

/// The arguments of texture("NAME", factor, channel); the last two are optional.
struct TextureCall {
    TextureId texture = kNoTexture;
    std::optional<TextNode> factor;
    std::optional<Channel> channel;
};
std::optional<TextureCall> read_texture_call(TextNode value, std::string_view key,
                                             NativeContext& context) {
    const auto fail = [&] {
        ValueReader{context.diagnostics}.fail(
            value, key,
            "texture(\"NAME\"), texture(\"NAME\", factor) or, for a number, texture(\"NAME\", "
            "factor, "
            "channel) with channel mean, red, green, blue or alpha");
        return std::nullopt;
    };
    const TextNode list = value.empty() ? value : value.first();
    const std::size_t count = list.is(NodeKind::List) ? list.size() : 0;
    if (value.broken()) return std::nullopt;
    if (count < 1 || count > 3 || !list.first().is(NodeKind::String)) return fail();
    const auto id = look_up(list.first(), "texture", context.texture_names, context.diagnostics);
    if (!id) return std::nullopt;
    TextureCall call{*id, std::nullopt, std::nullopt};
    auto argument = list.begin();
    if (count >= 2) call.factor = *++argument;
    if (count == 3) {
        const TextNode word = *++argument;
        for (const auto& [name, channel] : native_words<Channel>()) {
            if (word.is(NodeKind::Word, name)) call.channel = channel;
        }
        if (!call.channel) return fail();
    }
    return call;
}

/// Reads a texture call for a colour, which has no channel.
std::optional<TextureCall> read_whole_texture_call(TextNode value, std::string_view key,
                                                   NativeContext& context) {
    auto call = read_texture_call(value, key, context);
    if (!call || !call->channel) return call;
    ValueReader{context.diagnostics}.fail(value, key,
                                          "texture(\"NAME\") or texture(\"NAME\", factor)");
    return std::nullopt;
}

bool read_color(BlockReader& reader, std::string_view key, NativeContext& context,
                ColorInput& out) {
    const auto value = reader.find(key);
    if (!value) return false;
    if (!value->is(NodeKind::Entry, "texture")) {
        return read_native_color(*value, key, reader.values(), out.color);
    }
    const auto call = read_whole_texture_call(*value, key, context);
    if (!call) return false;
    ColorInput input{{1, 1, 1}, call->texture};
    if (call->factor && !read_native_color(*call->factor, key, reader.values(), input.color)) {
        return false;
    }
    out = input;
    return true;
}

void read_scalar(BlockReader& reader, std::string_view key, NativeContext& context,
                 ScalarInput& out) {
    const auto value = reader.find(key);
    if (!value) return;
    if (!value->is(NodeKind::Entry, "texture")) {
        reader.values().read(*value, key, out.value);
        return;
    }
    const auto call = read_texture_call(*value, key, context);
    if (!call) return;
    ScalarInput input{1, call->texture, call->channel.value_or(out.channel)};
    if (call->factor) reader.values().read(*call->factor, key, input.value);
    out = input;
}

void read_normal_map(BlockReader& reader, NativeContext& context, NormalMap& out) {
    constexpr std::string_view kKey = "normal_map";
    const auto value = reader.find(kKey);
    if (!value) return;
    if (!value->is(NodeKind::Entry, "texture")) {
        reader.values().fail(*value, kKey, "texture(\"NAME\") or texture(\"NAME\", scale)");
        return;
    }
    const auto call = read_whole_texture_call(*value, kKey, context);
    if (!call) return;
    out.texture = call->texture;
    if (call->factor) reader.values().read(*call->factor, kKey, out.scale);
}

void read_alpha(BlockReader& reader, NativeContext& context, Material& m) {
    reader.read_word("alpha_mode", native_words<AlphaMode>(), m.alpha_mode);
    read_scalar(reader, "alpha", context, m.alpha);
    reader.read("alpha_cutoff", m.alpha_cutoff);
    reader.read("double_sided", m.double_sided);
}

/// Reads the block `key`, if there is one.
template <class F>
void read_layer(BlockReader& outer, std::string_view key, NativeContext& context, const F& fields) {
    const auto value = outer.find(key);
    if (!value) return;
    if (!value->is(NodeKind::Block)) {
        outer.values().fail(*value, key, "a block { }");
        return;
    }
    BlockReader reader = context.reader(*value, std::string(key));
    fields(reader);
    reader.finish();
}

/// Reads texture("NAME") without further arguments.
void read_plain_texture(BlockReader& reader, std::string_view key, NativeContext& context,
                        TextureId& out) {
    const auto value = reader.find(key);
    if (!value) return;
    if (!value->is(NodeKind::Entry, "texture")) {
        reader.values().fail(*value, key, "texture(\"NAME\")");
        return;
    }
    if (const auto call = read_whole_texture_call(*value, key, context)) out = call->texture;
}

void read_layers(BlockReader& outer, NativeContext& context, MetallicRoughness& p) {
    read_layer(outer, "coat", context, [&](BlockReader& reader) {
        read_scalar(reader, "strength", context, p.coat.strength);
        read_scalar(reader, "roughness", context, p.coat.roughness);
        read_normal_map(reader, context, p.coat.normal_map);
    });
    read_layer(outer, "sheen", context, [&](BlockReader& reader) {
        read_color(reader, "color", context, p.sheen.color);
        read_scalar(reader, "roughness", context, p.sheen.roughness);
    });
    read_layer(outer, "film", context, [&](BlockReader& reader) {
        read_scalar(reader, "strength", context, p.film.strength);
        reader.read("index", p.film.index);
        reader.read("thinnest_nm", p.film.thinnest_nm);
        reader.read("thickest_nm", p.film.thickest_nm);
        read_plain_texture(reader, "thickness", context, p.film.thickness_texture);
    });
    read_layer(outer, "anisotropy", context, [&](BlockReader& reader) {
        reader.read("strength", p.anisotropy.strength);
        reader.read("rotation", p.anisotropy.rotation);
        read_plain_texture(reader, "texture", context, p.anisotropy.texture);
    });
    read_layer(outer, "diffuse_transmission", context, [&](BlockReader& reader) {
        read_scalar(reader, "share", context, p.diffuse_transmission.share);
        read_color(reader, "color", context, p.diffuse_transmission.color);
    });
}

void read_metallic_roughness(BlockReader& outer, NativeContext& context, Material& m) {
    constexpr std::string_view kKey = "metallic_roughness";
    const auto value = outer.find(kKey);
    if (!value) return;
    if (!value->is(NodeKind::Block)) {
        outer.values().fail(*value, kKey, "a block { }");
        return;
    }
    BlockReader reader = context.reader(*value, std::string(kKey));
    MetallicRoughness& p = m.metallic_roughness.emplace();
    read_color(reader, "base_color", context, p.base_color);
    read_scalar(reader, "metallic", context, p.metallic);
    read_scalar(reader, "roughness", context, p.roughness);
    read_scalar(reader, "occlusion", context, p.occlusion);
    read_scalar(reader, "specular", context, p.specular);
    read_color(reader, "specular_color", context, p.specular_color);
    read_scalar(reader, "transmission", context, p.transmission);
    read_scalar(reader, "thickness", context, p.thickness);
    if (reader.read("attenuation_distance", p.attenuation_distance) &&
        !(p.attenuation_distance > 0)) {
        reader.error(*reader.find("attenuation_distance"),
                     "'attenuation_distance' must be greater than 0");
    }
    if (const auto color = reader.find("attenuation_color")) {
        read_native_color(*color, "attenuation_color", reader.values(), p.attenuation_color);
    }
    read_layers(reader, context, p);
    reader.read("dispersion", p.dispersion);
    reader.read("unlit", p.unlit);
    reader.finish();
}

void read_conductor(BlockReader& outer, NativeContext& context, Material& m) {
    constexpr std::string_view kKey = "conductor";
    const auto value = outer.find(kKey);
    if (!value) return;
    if (value->is(NodeKind::String)) {
        const Metal* metal = find_metal(value->text());
        if (metal != nullptr) {
            m.conductor = Conductor{metal->index, metal->extinction, std::string(metal->name)};
            return;
        }
        std::string names;
        for (const Metal& known : metals()) {
            names += (names.empty() ? "" : ", ") + std::string(known.name);
        }
        outer.values().fail(*value, kKey, "one of " + names);
        return;
    }
    if (!value->is(NodeKind::Block)) {
        outer.values().fail(*value, kKey, "the name of a metal or a block { }");
        return;
    }
    BlockReader reader = context.reader(*value, std::string(kKey));
    Conductor& c = m.conductor.emplace();
    reader.require("index");
    reader.require("extinction");
    if (const auto v = reader.find("index")) {
        read_native_color(*v, "index", reader.values(), c.index);
    }
    if (const auto v = reader.find("extinction")) {
        read_native_color(*v, "extinction", reader.values(), c.extinction);
    }
    reader.finish();
}

void read_dielectric(BlockReader& outer, NativeContext& context, Material& m) {
    read_layer(outer, "dielectric", context, [&](BlockReader& reader) {
        Dielectric& d = m.dielectric.emplace();
        if (const auto v = reader.find("absorption")) {
            read_native_color(*v, "absorption", reader.values(), d.absorption);
        }
    });
}

/// Reads blackbody(KELVIN) or illuminant("NAME"). The last argument of both is an optional
/// luminance, by default 1.
void read_illuminant(TextNode value, NativeContext& context, Material& m) {
    constexpr std::string_view kKey = "emission";
    const ValueReader values{context.diagnostics};
    const bool is_body = value.is(NodeKind::Entry, "blackbody");
    const char* const expected = is_body
                                     ? "blackbody(KELVIN) or blackbody(KELVIN, luminance), 500 to "
                                       "1000000 K, with a luminance of at least 0"
                                     : "illuminant(\"NAME\") or illuminant(\"NAME\", luminance), "
                                       "with the name A, D65 or E and a luminance of at least 0";
    const TextNode list = value.empty() ? value : value.first();
    if (value.broken()) return;
    const std::size_t count = list.is(NodeKind::List) ? list.size() : 0;
    if (count < 1 || count > 2) return (void)values.fail(value, kKey, expected);
    Illuminant light;
    auto argument = list.begin();
    if (is_body) {
        light.kind = IlluminantKind::BlackBody;
        if (!values.read(*argument, kKey, light.kelvin)) return;
        if (!(light.kelvin >= 500.0 && light.kelvin <= 1e6)) {
            return (void)values.fail(value, kKey, expected);
        }
    } else {
        bool known = false;
        for (const auto& [name, kind] : native_words<IlluminantKind>()) {
            if (!(*argument).is(NodeKind::String) || (*argument).text() != name) continue;
            light.kind = kind;
            known = true;
        }
        if (!known) return (void)values.fail(value, kKey, expected);
    }
    if (count == 2 && !values.read(*++argument, kKey, light.scale)) return;
    if (!(light.scale >= 0.0)) return (void)values.fail(value, kKey, expected);
    m.illuminant = light;
    m.emission = {color_in_gamut(light), kNoTexture};
}

void read_emission_of_material(BlockReader& reader, NativeContext& context, Material& m) {
    const auto value = reader.find("emission");
    if (value &&
        (value->is(NodeKind::Entry, "blackbody") || value->is(NodeKind::Entry, "illuminant"))) {
        read_illuminant(*value, context, m);
    } else {
        read_color(reader, "emission", context, m.emission);
    }
}

void read_glass(BlockReader& reader, TextNode value, Material& m) {
    const NamedGlass* const glass = value.is(NodeKind::String) ? find_glass(value.text()) : nullptr;
    if (glass == nullptr) {
        std::string names;
        for (const NamedGlass& known : named_glasses()) {
            names += (names.empty() ? "" : ", ") + std::string(known.name);
        }
        reader.values().fail(value, "glass", "one of " + names);
        return;
    }
    m.dispersion = Dispersion{.sellmeier = glass->sellmeier, .name = std::string(glass->name)};
}

void read_sellmeier(BlockReader& reader, TextNode value, Material& m) {
    constexpr std::string_view kKey = "sellmeier";
    const char* const expected =
        "2, 4, 6 or 8 numbers: the strengths, then as many poles in square micrometres, with an "
        "index from 380 to 780 nm";
    const std::size_t count = value.is(NodeKind::List) ? value.size() : 0;
    double numbers[8];
    if (count < 2 || count > 8 || count % 2 != 0) {
        reader.values().fail(value, kKey, expected);
        return;
    }
    if (!reader.values().read_numbers(value, kKey, static_cast<int>(count), numbers)) return;
    Dispersion d;
    for (std::size_t i = 0; i < count / 2; ++i) {
        d.sellmeier.strength[i] = numbers[i];
        d.sellmeier.pole[i] = numbers[count / 2 + i];
    }
    for (double nm = 380.0; nm <= 780.0; nm += 5.0) {
        if (const double n = d.sellmeier.index(nm); !(n > 0.1 && n < 20.0)) {
            reader.values().fail(value, kKey, expected);
            return;
        }
    }
    m.dispersion = d;
}

/// Reads the dependence of the index on the wavelength: `glass`, `sellmeier` or `abbe`. A material
/// of nothing else is a clear dielectric.
void read_dispersion(BlockReader& reader, Material& m) {
    const auto glass = reader.find("glass"), sellmeier = reader.find("sellmeier"),
               abbe = reader.find("abbe");
    if ((glass ? 1 : 0) + (sellmeier ? 1 : 0) + (abbe ? 1 : 0) > 1) {
        reader.error(reader.block(),
                     "'glass', 'sellmeier' and 'abbe' exclude each other; expected one of them");
        return;
    }
    if ((glass || sellmeier) && reader.has("index")) {
        reader.error(reader.block(), "'glass' and 'sellmeier' give the index; expected no 'index'");
        return;
    }
    if (glass) read_glass(reader, *glass, m);
    if (sellmeier) read_sellmeier(reader, *sellmeier, m);
    if (abbe) {
        double number = 0;
        if (!reader.values().read(*abbe, "abbe", number)) return;
        if (!(number > 0.0) || !std::isfinite(number)) {
            reader.values().fail(*abbe, "abbe", "a number above 0");
            return;
        }
        m.dispersion = Dispersion{.abbe = number};
    }
    if (!m.dispersion) return;
    if (!abbe) m.index.value = m.dispersion->sellmeier.index(kLineD);
    const bool has_coefficients = std::ranges::any_of(
        std::array{"ambient", "diffuse", "specular", "reflective", "transmissive"},
        [&](const char* key) { return reader.has(key); });
    if (!m.metallic_roughness && !m.conductor && !m.dielectric && !has_coefficients) {
        m.dielectric.emplace();
    }
}

MaterialId add_material(TextNode block, std::string name, NativeContext& context) {
    BlockReader reader = context.reader(block, "material");
    Material m;
    m.name = std::move(name);
    reader.read("name", m.name);
    read_emission_of_material(reader, context, m);
    const bool has_ambient = reader.has("ambient");
    read_color(reader, "ambient", context, m.ambient);
    read_color(reader, "diffuse", context, m.diffuse);
    read_color(reader, "specular", context, m.specular);
    read_color(reader, "reflective", context, m.reflective);
    read_color(reader, "transmissive", context, m.transmissive);
    read_scalar(reader, "shininess", context, m.shininess);
    read_scalar(reader, "roughness", context, m.roughness);
    read_scalar(reader, "index", context, m.index);
    if (double density = 0; reader.read("density", density)) m.density = density;
    if (const auto v = reader.find("scattering")) {
        read_native_color(*v, "scattering", reader.values(), m.scattering.coefficient);
    }
    reader.read("scattering_anisotropy", m.scattering.anisotropy);
    if (!has_ambient) m.ambient = m.diffuse;
    read_alpha(reader, context, m);
    read_normal_map(reader, context, m.normal_map);
    read_metallic_roughness(reader, context, m);
    read_conductor(reader, context, m);
    read_dielectric(reader, context, m);
    read_dispersion(reader, m);
    reader.finish();
    context.scene.materials.push_back({std::move(m), block.location()});
    return static_cast<MaterialId>(context.scene.materials.size() - 1);
}

/// The default material of parts, a matte grey.
MaterialId built_in_material(NativeContext& context) {
    if (!context.built_in_material) {
        Material grey;
        grey.name = "default";
        grey.diffuse.color = grey.ambient.color = {0.7, 0.7, 0.7};
        context.scene.materials.push_back({grey, {}});
        context.built_in_material = static_cast<MaterialId>(context.scene.materials.size() - 1);
    }
    return *context.built_in_material;
}

}  // namespace

void read_native_material(const NativeBlock& block, NativeContext& context) {
    if (!block.block) return;
    if (block.name.empty()) {
        context.diagnostics.error(block.location,
                                  "material: expected a name, as in material \"red\" { }");
    }
    const MaterialId id = add_material(*block.block, block.name, context);
    if (!block.name.empty()) {
        define_name(block.name, id, "material", block.location, context.material_names,
                    context.diagnostics);
    }
}

std::optional<MaterialId> read_material_value(TextNode value, NativeContext& context) {
    if (value.broken()) return std::nullopt;
    if (value.is(NodeKind::Block)) return add_material(value, "", context);
    if (value.is(NodeKind::String) || value.is(NodeKind::Word)) {
        return look_up(value, "material", context.material_names, context.diagnostics);
    }
    ValueReader{context.diagnostics}.fail(value, "material",
                                          "the name of a material or a block { }");
    return std::nullopt;
}

MaterialId read_part_material(BlockReader& reader, NativeContext& context,
                              const NativeScope& scope) {
    std::optional<MaterialId> id;
    if (const auto value = reader.find("material")) id = read_material_value(*value, context);
    if (!id) id = scope.material;
    return id ? *id : built_in_material(context);
}

}  // namespace alhazen
