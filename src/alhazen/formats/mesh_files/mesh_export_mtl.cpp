// Materials as MTL, with a line for each kind of property that MTL cannot express.

#include <algorithm>
#include <cmath>

#include "alhazen/formats/mesh_files/mesh_export.h"
#include "alhazen/formats/mesh_files/mesh_export_text.h"

namespace alhazen {

namespace {

/// Lost properties: one entry for each kind, with its count and first occurrence.
class Losses {
  public:
    void add(const std::string& what, const std::string& material) {
        const auto known = std::find_if(all_.begin(), all_.end(),
                                        [&](const Loss& loss) { return loss.what == what; });
        if (known == all_.end()) {
            all_.push_back({what, material, 1});
        } else {
            ++known->count;
        }
    }
    void list(std::vector<std::string>& lines) const {
        for (const Loss& loss : all_) {
            std::string line = loss.what + " (material '" + loss.material.substr(0, 200) + "'";
            if (loss.count > 1) line += ", " + std::to_string(loss.count) + " times in all";
            lines.push_back(line + ")");
        }
    }

  private:
    struct Loss {
        std::string what, material;
        std::size_t count = 0;
    };
    std::vector<Loss> all_;
};

class MtlWriter {
  public:
    MtlWriter(std::span<const MtlTexture> textures, Losses& losses)
        : textures_(textures), losses_(losses) {}

    std::string write(std::span<const Material> materials) {
        out_ = "# Alhazen\n";
        for (const Material& m : materials) {
            name_ = one_name(m.name);
            out_ += "newmtl " + name_ + '\n';
            const bool clear = scattering_of(m);
            color("Ke", "map_Ke", m.emission);
            if (m.illuminant) lose("the spectrum of the emission");
            alpha(m, clear);
            if (!m.double_sided) lose("single-sided visibility");
            map("norm", m.normal_map.texture, false, bump_option(m.normal_map.scale));
            if (m.index.texture != kNoTexture) lose("the texture of the index of refraction");
            if (m.dispersion) lose("dispersion");
            if (!m.scattering.coefficient.is_black()) lose("scattering inside a volume");
            if (m.density) lose("a density");
        }
        return std::move(out_);
    }

  private:
    void lose(const std::string& what) { losses_.add(what, name_); }

    /// Writes how the surface scatters light, in the precedence of `evaluate`; true if light passes
    /// through the body.
    bool scattering_of(const Material& m) {
        if (m.metallic_roughness) return metallic_roughness(m, *m.metallic_roughness);
        if (m.conductor) {
            lose("the complex index of a conductor, written as a metal of its colour");
            return metallic_roughness(m, metal_of(m));
        }
        if (m.dielectric) {
            if (!m.dielectric->absorption.is_black()) lose("the absorption of a dielectric");
            MetallicRoughness clear;
            clear.metallic.value = 0;
            clear.roughness = m.roughness;
            clear.transmission.value = clear.thickness.value = 1;
            return metallic_roughness(m, clear);
        }
        return whitted(m);
    }
    /// The metal whose base colour is the conductor's reflectance at normal incidence.
    static MetallicRoughness metal_of(const Material& m) {
        Material bare;
        bare.conductor = m.conductor;
        MetallicRoughness metal;
        metal.base_color.color = evaluate(bare, {}, SurfaceLookup{}).albedo;
        metal.roughness = m.roughness;
        return metal;
    }

    void alpha(const Material& m, bool clear) {
        if (m.alpha_mode == AlphaMode::Opaque) return;
        // With these models of `illum`, d is a factor of Tf.
        if (clear) return lose("the alpha of a transparent body");
        if (m.alpha_mode == AlphaMode::Mask) lose("the alpha threshold");
        scalar("d", "map_d", m.alpha);
    }

    /// Ka as it reads back: a black one would stand for the diffuse colour, and the texture of the
    /// diffuse colour multiplies one without a texture.
    void ambient(const Material& m) {
        constexpr double kNearlyBlack = 1e-30;
        ColorInput written = m.ambient;
        if (written.color.is_black()) {
            written.texture = kNoTexture;
            if (!m.diffuse.color.is_black()) {
                written.color = {kNearlyBlack, kNearlyBlack, kNearlyBlack};
            }
        } else if (has_map(m.diffuse) && !has_map(m.ambient)) {
            lose("an ambient colour without the texture of the diffuse one");
        }
        color("Ka", "map_Ka", written);
    }

    bool whitted(const Material& m) {
        const bool glass = !is_black(m.transmissive);
        const bool mirror = !is_black(m.reflective);
        ambient(m);
        color("Kd", "map_Kd", m.diffuse);
        // MTL has a single colour for the highlight and the reflection.
        const bool highlight = !is_black(m.specular);
        if (mirror && highlight &&
            (m.specular.color != m.reflective.color ||
             m.specular.texture != m.reflective.texture)) {
            lose("different colours of highlight and reflection");
        }
        color("Ks", "map_Ks", highlight ? m.specular : m.reflective);
        if (highlight && m.shininess.value == 0.0) lose("a highlight of exponent 0");
        if (m.roughness.value != 0.0) lose("the roughness of reflection and refraction");
        // An exponent would create a highlight in the colour of the reflection.
        scalar("Ns", "map_Ns", highlight || !mirror ? m.shininess : ScalarInput{});
        number("Ni", m.index.value);
        if (glass) {
            color("Tf", nullptr, m.transmissive);
            if (!mirror && highlight) lose("glass with a highlight but without reflection");
        }
        out_ += glass ? "illum 7\n" : mirror ? "illum 3\n" : "illum 2\n";
        return glass;
    }
    bool metallic_roughness(const Material& m, const MetallicRoughness& mr) {
        color("Kd", "map_Kd", mr.base_color);
        scalar("Pm", "map_Pm", mr.metallic);
        scalar("Pr", "map_Pr", mr.roughness);
        if (mr.coat.strength.value > 0.0) coat(mr.coat);
        number("Ni", m.index.value);
        const bool all_metal = mr.metallic.value >= 1.0 && mr.metallic.texture == kNoTexture;
        if (m.index.value < 1.0 && !all_metal) {
            lose("an index of refraction below 1 beside metallic-roughness parameters");
        }
        if (mr.transmission.value > 0.0) {
            color("Tf", nullptr, {mr.transmission.value * Rgb{1, 1, 1}, mr.transmission.texture});
            out_ += "illum 7\n";
        } else {
            out_ += "illum 2\n";
        }
        if (mr.occlusion.texture != kNoTexture) lose("the occlusion texture");
        if (mr.specular.value != 1.0 || mr.specular.texture != kNoTexture ||
            mr.specular_color.color != Rgb{1, 1, 1} || mr.specular_color.texture != kNoTexture) {
            lose("strength and colour of the dielectric reflection");
        }
        if (mr.unlit) lose("unlit shading");
        if (mr.transmission.value > 0.0 && mr.thickness.value == 0.0)
            lose("thin-walled transmission");
        if (std::isfinite(mr.attenuation_distance) && mr.attenuation_color != Rgb{1, 1, 1}) {
            lose("the attenuation colour");
        }
        if (!is_black(mr.sheen.color)) lose("the sheen");
        if (mr.film.strength.value > 0.0) lose("the iridescent film");
        if (mr.anisotropy.strength != 0.0) lose("the anisotropy");
        if (mr.diffuse_transmission.share.value > 0.0) lose("the diffuse transmission");
        if (mr.dispersion > 0.0) lose("dispersion");
        return mr.transmission.value > 0.0;
    }
    void coat(const ClearCoat& coat) {
        number("Pc", coat.strength.value);
        number("Pcr", coat.roughness.value);
        if (coat.strength.texture != kNoTexture || coat.roughness.texture != kNoTexture) {
            lose("the textures of the clear coat");
        }
        if (coat.normal_map.texture != kNoTexture) lose("the normal map of the clear coat");
    }

    /// True if `color` writes a map.
    [[nodiscard]] bool has_map(const ColorInput& c) const {
        return c.texture != kNoTexture && std::size_t(c.texture) < textures_.size() &&
               !textures_[std::size_t(c.texture)].file.empty() && !c.color.is_black();
    }
    static bool is_black(const ColorInput& c) {
        return c.texture == kNoTexture && c.color.is_black();
    }
    /// `map_word` null: MTL has no such statement.
    void color(const char* word, const char* map_word, const ColorInput& input) {
        out_ += word;
        for (const double c : {input.color.r, input.color.g, input.color.b}) {
            append_number(out_, c);
        }
        out_ += '\n';
        if (input.texture == kNoTexture) return;
        if (map_word == nullptr) return lose("the texture of " + std::string(word));
        // Black together with an image would read back as white.
        if (!input.color.is_black()) map(map_word, input.texture, true);
    }
    void scalar(const char* word, const char* map_word, const ScalarInput& input) {
        number(word, input.value);
        static constexpr std::array<const char*, 5> kChannels{"l", "r", "g", "b", "m"};
        const char* channel = kChannels[std::size_t(input.channel)];
        map(map_word, input.texture, false, std::string(" -imfchan ") + channel);
    }
    void number(const char* word, double value) {
        out_ += word;
        append_number(out_, value);
        out_ += '\n';
    }
    static std::string bump_option(double scale) {
        std::string option;
        if (scale != 1.0) {
            option = " -bm";
            append_number(option, scale);
        }
        return option;
    }

    void map(const char* word, TextureId id, bool is_color, const std::string& options = {}) {
        if (id == kNoTexture || std::size_t(id) >= textures_.size()) return;
        const MtlTexture& texture = textures_[std::size_t(id)];
        if (texture.file.empty()) return;
        out_ += word + options;
        placement(texture.settings);
        wrap(texture.settings);
        out_ += ' ' + one_line(texture.file) + '\n';
        lookup(texture.settings, is_color);
    }
    void placement(const ImageTexture& t) {
        const UvTransform& uv = t.uv_transform;
        if (uv.uu != 1.0 || uv.vv != 1.0) three_numbers(" -s", uv.uu, uv.vv, 1.0);
        if (uv.offset.x != 0.0 || uv.offset.y != 0.0) {
            three_numbers(" -o", uv.offset.x, uv.offset.y, 0.0);
        }
        if (uv.uv != 0.0 || uv.vu != 0.0) lose("the rotation of texture coordinates");
    }
    void wrap(const ImageTexture& t) {
        if (t.wrap_u == Wrap::Mirror || t.wrap_v == Wrap::Mirror) {
            lose("the mirrored repeat of a texture");
        } else if (t.wrap_u != t.wrap_v) {
            lose("the repeat of a texture along one axis only");
        } else if (t.wrap_u == Wrap::Clamp) {
            out_ += " -clamp on";
        }
    }
    void lookup(const ImageTexture& t, bool is_color) {
        if (t.uv_set != 0) lose("the second set of texture coordinates");
        if (t.filter != TextureFilter::Mipmapped) lose("the filter of a texture");
        if (t.corner_texels) lose("corner-aligned texels");
        // 8-bit and 16-bit colours are read as sRGB, all others as linear.
        const bool codes = t.image && !std::holds_alternative<std::vector<float>>(t.image->samples);
        if (t.image && t.decode_srgb != (is_color && codes)) {
            lose(t.decode_srgb ? "the sRGB encoding of a data texture"
                               : "the linear encoding of a colour texture");
        }
    }
    void three_numbers(const char* word, double a, double b, double c) {
        out_ += word;
        for (const double number : {a, b, c}) append_number(out_, number);
    }

    std::span<const MtlTexture> textures_;
    Losses& losses_;
    std::string name_;  ///< name of the current material
    std::string out_;
};

}  // namespace

std::string mtl_text(std::span<const Material> materials, std::span<const MtlTexture> textures,
                     std::vector<std::string>& lost) {
    Losses losses;
    std::string text = MtlWriter(textures, losses).write(materials);
    losses.list(lost);
    return text;
}

}  // namespace alhazen
