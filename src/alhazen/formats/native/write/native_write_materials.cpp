#include <cmath>
#include <map>

#include "alhazen/base/overloaded.h"
#include "alhazen/formats/native/native_words.h"
#include "alhazen/formats/native/write/native_write_context.h"
#include "alhazen/formats/pictures/picture_export.h"

namespace alhazen {

namespace {

class MaterialText {
  public:
    MaterialText(const NativeWriteContext& context, NativeBlockText& block)
        : context_(context), block_(block) {}

    /// Adds an input unless it equals `usual`.
    void add(std::string_view key, const ColorInput& input, const ColorInput& usual) {
        const std::string value = text_of(input);
        if (value != text_of(usual)) block_.add(key, value);
    }
    void add(std::string_view key, const ScalarInput& input, const ScalarInput& usual) {
        const std::string value = text_of(input, usual.channel);
        if (value != text_of(usual, usual.channel)) block_.add(key, value);
    }
    void add(std::string_view key, const NormalMap& map) {
        if (map.texture != kNoTexture) {
            block_.add(key, call(map.texture, map.scale != 1 ? native_value(map.scale) : "", ""));
        }
    }

    void add(std::string_view key, TextureId texture) {
        if (texture != kNoTexture) block_.add(key, call(texture, "", ""));
    }

  private:
    [[nodiscard]] std::string call(TextureId texture, const std::string& factor,
                                   const std::string& channel) const {
        const auto& label = context_.texture_labels[static_cast<std::size_t>(texture)];
        std::string text = "texture(" + native_string(label);
        if (!factor.empty()) text += ", " + factor;
        if (!channel.empty()) text += ", " + channel;
        return text + ")";
    }
    [[nodiscard]] std::string text_of(const ColorInput& input) const {
        const std::string color = native_value(input.color);
        if (input.texture == kNoTexture) return color;
        return call(input.texture, color == native_value(Rgb{1, 1, 1}) ? "" : color, "");
    }
    [[nodiscard]] std::string text_of(const ScalarInput& input, Channel usual) const {
        const std::string value = native_value(input.value);
        if (input.texture == kNoTexture) return value;
        if (input.channel != usual) {
            return call(input.texture, value, std::string(native_word(input.channel)));
        }
        return call(input.texture, value == "1" ? "" : value, "");
    }

    const NativeWriteContext& context_;
    NativeBlockText& block_;
};

/// Adds the layers of `p` that differ from the default, each as a block.
void add_layers(const NativeWriteContext& context, const MetallicRoughness& p,
                NativeBlockText& block) {
    const MetallicRoughness usual;
    const auto layer = [&](std::string_view key, const auto& fields) {
        NativeBlockText text;
        MaterialText inputs(context, text);
        fields(text, inputs);
        if (!text.empty()) block.add(key, text.value(8));
    };
    layer("coat", [&](NativeBlockText&, MaterialText& inputs) {
        inputs.add("strength", p.coat.strength, usual.coat.strength);
        inputs.add("roughness", p.coat.roughness, usual.coat.roughness);
        inputs.add("normal_map", p.coat.normal_map);
    });
    layer("sheen", [&](NativeBlockText&, MaterialText& inputs) {
        inputs.add("color", p.sheen.color, usual.sheen.color);
        inputs.add("roughness", p.sheen.roughness, usual.sheen.roughness);
    });
    layer("film", [&](NativeBlockText& text, MaterialText& inputs) {
        inputs.add("strength", p.film.strength, usual.film.strength);
        text.add_unless("index", p.film.index, usual.film.index);
        text.add_unless("thinnest_nm", p.film.thinnest_nm, usual.film.thinnest_nm);
        text.add_unless("thickest_nm", p.film.thickest_nm, usual.film.thickest_nm);
        inputs.add("thickness", p.film.thickness_texture);
    });
    layer("anisotropy", [&](NativeBlockText& text, MaterialText& inputs) {
        text.add_unless("strength", p.anisotropy.strength, usual.anisotropy.strength);
        text.add_unless("rotation", p.anisotropy.rotation, usual.anisotropy.rotation);
        inputs.add("texture", p.anisotropy.texture);
    });
    layer("diffuse_transmission", [&](NativeBlockText&, MaterialText& inputs) {
        inputs.add("share", p.diffuse_transmission.share, usual.diffuse_transmission.share);
        inputs.add("color", p.diffuse_transmission.color, usual.diffuse_transmission.color);
    });
}

void add_metallic_roughness(const NativeWriteContext& context, const MetallicRoughness& p,
                            NativeBlockText& material) {
    const MetallicRoughness usual;
    NativeBlockText block;
    MaterialText inputs(context, block);
    inputs.add("base_color", p.base_color, usual.base_color);
    inputs.add("metallic", p.metallic, usual.metallic);
    inputs.add("roughness", p.roughness, usual.roughness);
    inputs.add("occlusion", p.occlusion, usual.occlusion);
    inputs.add("specular", p.specular, usual.specular);
    inputs.add("specular_color", p.specular_color, usual.specular_color);
    inputs.add("transmission", p.transmission, usual.transmission);
    inputs.add("thickness", p.thickness, usual.thickness);
    if (std::isfinite(p.attenuation_distance)) {
        block.add("attenuation_distance", native_value(p.attenuation_distance));
    }
    block.add_unless("attenuation_color", p.attenuation_color, usual.attenuation_color);
    add_layers(context, p, block);
    block.add_unless("dispersion", p.dispersion, usual.dispersion);
    block.add_unless("unlit", p.unlit, usual.unlit);
    material.add("metallic_roughness", block.value(4));
}

void add_conductor(const Conductor& c, NativeBlockText& material) {
    if (!c.name.empty()) {
        material.add("conductor", native_string(c.name));
        return;
    }
    NativeBlockText block;
    block.add("index", native_value(c.index));
    block.add("extinction", native_value(c.extinction));
    material.add("conductor", block.value(4));
}

std::string emission_text(const Illuminant& light) {
    const std::string scale = ", " + native_value(light.scale) + ")";
    if (light.kind == IlluminantKind::BlackBody) {
        return "blackbody(" + native_value(light.kelvin) + scale;
    }
    return "illuminant(" + native_string(native_word(light.kind)) + scale;
}

void add_dispersion(const Dispersion& d, NativeBlockText& material) {
    if (!d.name.empty()) {
        material.add("glass", native_string(d.name));
    } else if (d.abbe > 0.0) {
        material.add("abbe", native_value(d.abbe));
    } else {
        std::string numbers;
        for (const double b : d.sellmeier.strength) numbers += native_value(b) + ", ";
        for (const double c : d.sellmeier.pole) numbers += native_value(c) + ", ";
        numbers.resize(numbers.size() - 2);
        material.add("sellmeier", "(" + numbers + ")");
    }
}

/// True if the reader takes a material of an index alone for a clear dielectric, which it is not.
bool would_become_clear(const Material& m) {
    const auto is_usual = [](const ColorInput& c) {
        return c.texture == kNoTexture && c.color.is_black();
    };
    return m.dispersion && !m.metallic_roughness && !m.conductor && !m.dielectric &&
           is_usual(m.ambient) && is_usual(m.diffuse) && is_usual(m.specular) &&
           is_usual(m.reflective) && is_usual(m.transmissive);
}

// Pictures.

std::string write_picture(const NativeWriteContext& context, const StoredImage& image,
                          std::size_t number) {
    const PictureFile file = picture_file(image);
    return context.write_file("texture_" + std::to_string(number) + "." + file.suffix, file.bytes);
}

std::string uv_rows(const UvTransform& t) {
    return "(" + native_value(Vec3{t.uu, t.uv, t.offset.x}) + ", " +
           native_value(Vec3{t.vu, t.vv, t.offset.y}) + ")";
}

NativeBlockText solid_texture_block(const std::string& label, const std::string& name,
                                    const SolidTexture& t) {
    const SolidTexture usual;
    NativeBlockText block("solid_texture", label);
    add_name(block, label, name);
    block.add("kind", std::string(native_word(t.kind)));
    block.add_unless("color", t.color.rgb(), usual.color.rgb());
    block.add_unless("other", t.other.rgb(), usual.other.rgb());
    block.add_unless("origin", t.origin, usual.origin);
    block.add_unless("size", t.size, usual.size);
    block.add_unless("direction", t.direction, usual.direction);
    block.add_unless("octaves", t.octaves, usual.octaves);
    block.add_unless("turbulence", t.turbulence, usual.turbulence);
    return block;
}

NativeBlockText image_texture_block(const std::string& label, const std::string& name,
                                    const ImageTexture& t, const std::string& file) {
    NativeBlockText block("texture", label);
    add_name(block, label, name);
    block.add("file", native_string(file));
    if (t.wrap_u != Wrap::Repeat) block.add("wrap_u", std::string(native_word(t.wrap_u)));
    if (t.wrap_v != Wrap::Repeat) block.add("wrap_v", std::string(native_word(t.wrap_v)));
    block.add("filter", std::string(native_word(t.filter)));
    block.add_unless("corner_texels", t.corner_texels, false);
    block.add("srgb", native_value(t.decode_srgb));
    block.add_unless("uv_set", t.uv_set, 0);
    const std::string rows = uv_rows(t.uv_transform);
    if (rows != uv_rows({})) block.add("uv_transform", rows);
    return block;
}

}  // namespace

void write_native_textures(NativeWriteContext& context) {
    std::map<const StoredImage*, std::string> files;  // shared pictures are written once
    for (std::size_t i = 0; i < context.scene.textures.size(); ++i) {
        const TextureDescription& description = context.scene.textures[i];
        const std::string& label = context.texture_labels[i];
        const auto solid = [&](const SolidTexture& t) {
            return solid_texture_block(label, description.name, t);
        };
        const auto image = [&](const ImageTexture& t) {
            std::string& file = files[t.image.get()];
            if (file.empty()) file = write_picture(context, *t.image, i);
            return image_texture_block(label, description.name, t, file);
        };
        context.append(std::visit(Overloaded{solid, image}, description.texture));
    }
}

void write_native_materials(NativeWriteContext& context) {
    for (std::size_t i = 0; i < context.scene.materials.size(); ++i) {
        const Material& m = context.scene.materials[i].material;
        const Material usual;
        NativeBlockText block("material", context.material_labels[i]);
        add_name(block, context.material_labels[i], m.name);
        MaterialText inputs(context, block);
        if (m.illuminant) {
            block.add("emission", emission_text(*m.illuminant));
        } else {
            inputs.add("emission", m.emission, usual.emission);
        }
        if (would_become_clear(m)) {
            block.add("diffuse", native_value(m.diffuse.color));
        } else {
            inputs.add("diffuse", m.diffuse, usual.diffuse);
        }
        inputs.add("ambient", m.ambient, m.diffuse);  // the reader's default
        inputs.add("specular", m.specular, usual.specular);
        inputs.add("reflective", m.reflective, usual.reflective);
        inputs.add("transmissive", m.transmissive, usual.transmissive);
        inputs.add("shininess", m.shininess, usual.shininess);
        const bool has_own_index = !m.dispersion || m.dispersion->abbe > 0.0;
        if (has_own_index) inputs.add("index", m.index, usual.index);
        if (m.dispersion) add_dispersion(*m.dispersion, block);
        inputs.add("roughness", m.roughness, usual.roughness);
        if (m.density) block.add("density", native_value(*m.density));
        block.add_unless("scattering", m.scattering.coefficient, Rgb{});
        block.add_unless("scattering_anisotropy", m.scattering.anisotropy, 0.0);
        if (m.alpha_mode != usual.alpha_mode) {
            block.add("alpha_mode", std::string(native_word(m.alpha_mode)));
        }
        inputs.add("alpha", m.alpha, usual.alpha);
        block.add_unless("alpha_cutoff", m.alpha_cutoff, usual.alpha_cutoff);
        block.add_unless("double_sided", m.double_sided, usual.double_sided);
        inputs.add("normal_map", m.normal_map);
        if (m.metallic_roughness) add_metallic_roughness(context, *m.metallic_roughness, block);
        if (m.conductor) add_conductor(*m.conductor, block);
        if (m.dielectric) {
            NativeBlockText body;
            body.add_unless("absorption", m.dielectric->absorption, Rgb{});
            block.add("dielectric", body.value(4));
        }
        context.append(block);
    }
}

}  // namespace alhazen
