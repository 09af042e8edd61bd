// Materials as MTL: what the format can say of them.

#include "alhazen/importers/mesh_export.h"
#include "alhazen/importers/mesh_export_text.h"

namespace alhazen {

namespace {

class MtlWriter {
  public:
    explicit MtlWriter(std::span<const std::string> texture_files) : files_(texture_files) {}

    std::string write(std::span<const Material> materials) {
        out_ = "# Alhazen\n";
        for (const Material& m : materials) {
            out_ += "newmtl " + one_line(m.name) + '\n';
            m.metallic_roughness ? metallic_roughness(m, *m.metallic_roughness) : whitted(m);
            color("Ke", "map_Ke", m.emission);
            if (m.alpha_mode != AlphaMode::Opaque) scalar("d", "map_d", m.alpha);
            map("norm", m.normal_map.texture, m.normal_map.scale);
        }
        return std::move(out_);
    }

  private:
    void whitted(const Material& m) {
        const bool glass = !is_black(m.transmissive);
        const bool mirror = !is_black(m.reflective);
        color("Ka", "map_Ka", m.ambient);
        color("Kd", "map_Kd", m.diffuse);
        // One colour stands for the highlight and the reflection.
        color("Ks", "map_Ks", is_black(m.specular) ? m.reflective : m.specular);
        scalar("Ns", "map_Ns", m.shininess);
        number("Ni", m.index.value);
        if (glass) color("Tf", nullptr, m.transmissive);
        out_ += glass ? "illum 7\n" : mirror ? "illum 3\n" : "illum 2\n";
    }
    void metallic_roughness(const Material& m, const MetallicRoughness& mr) {
        color("Kd", "map_Kd", mr.base_color);
        scalar("Pm", "map_Pm", mr.metallic);
        scalar("Pr", "map_Pr", mr.roughness);
        number("Ni", m.index.value);
        if (mr.transmission.value > 0.0) {
            color("Tf", nullptr, {mr.transmission.value * Rgb{1, 1, 1}, kNoTexture});
            out_ += "illum 7\n";
        } else {
            out_ += "illum 2\n";
        }
    }

    static bool is_black(const ColorInput& c) {
        return c.texture == kNoTexture && c.color.is_black();
    }
    void color(const char* word, const char* map_word, const ColorInput& input) {
        out_ += word;
        for (const double c : {input.color.r, input.color.g, input.color.b}) {
            append_number(out_, c);
        }
        out_ += '\n';
        if (map_word != nullptr) map(map_word, input.texture, 1.0);
    }
    void scalar(const char* word, const char* map_word, const ScalarInput& input) {
        number(word, input.value);
        static constexpr std::array<const char*, 5> kChannels{"l", "r", "g", "b", "m"};
        const char* channel = kChannels[std::size_t(input.channel)];
        map(map_word, input.texture, 1.0, std::string(" -imfchan ") + channel);
    }
    void number(const char* word, double value) {
        out_ += word;
        append_number(out_, value);
        out_ += '\n';
    }
    void map(const char* word, TextureId texture, double bump, const std::string& options = {}) {
        if (texture == kNoTexture || std::size_t(texture) >= files_.size()) return;
        const std::string& file = files_[std::size_t(texture)];
        if (file.empty()) return;
        out_ += word + options;
        if (bump != 1.0) {
            out_ += " -bm";
            append_number(out_, bump);
        }
        out_ += ' ' + one_line(file) + '\n';
    }

    std::span<const std::string> files_;
    std::string out_;
};

}  // namespace

std::string mtl_text(std::span<const Material> materials,
                     std::span<const std::string> texture_files) {
    return MtlWriter(texture_files).write(materials);
}

}  // namespace alhazen
