#include "alhazen/formats/gltf/scene/gltf_materials.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace alhazen::gltf {

namespace {

Rgb rgb(const std::array<double, 3>& c) {
    return {c[0], c[1], c[2]};
}

/// The albedo of a single scattering event, from the albedo of multiple scattering in a deep
/// volume.
///
/// Source: KHR_materials_volume_scatter (draft), after Kulla and Conty, "Revisiting Physically
/// Based Shading at Imageworks", SIGGRAPH 2017 course.
/// Differs: ignores the anisotropy, as the draft does.
Rgb single_scatter_albedo(const Rgb& multiple) {
    Rgb single;
    for (int i = 0; i < 3; ++i) {
        const double m = multiple[i];
        const double s = 4.09712 + 4.20863 * m - std::sqrt(9.59217 + 41.6808 * m + 17.7126 * m * m);
        single[i] = std::clamp(1.0 - s * s, 0.0, 1.0);
    }
    return single;
}

class MaterialMaker {
  public:
    explicit MaterialMaker(Textures& textures) : textures_(textures) {}

    alhazen::Material make(const Material& m, std::string name) {
        alhazen::Material out;
        out.name = std::move(name);
        out.emission = color(m.emissive_strength * rgb(m.emissive), m.emissive_texture);
        out.index.value = m.ior;
        out.alpha_mode = m.alpha_mode;
        out.alpha_cutoff = m.alpha_cutoff;
        out.double_sided = m.double_sided;
        if (m.normal_texture) {
            out.normal_map = {textures_.use(m.normal_texture, ColorSpace::Linear),
                              m.normal_texture->strength};
        }
        MetallicRoughness parameters = metallic_roughness(m);
        double alpha = m.base_color[3];
        if (const auto& old = m.specular_glossiness) {
            set_specular_glossiness(*old, parameters);
            alpha = old->diffuse[3];
            out.index.value = 0.0;
        }
        set_scattering(m, parameters, out.scattering);
        out.alpha = {alpha, parameters.base_color.texture, Channel::Alpha};
        out.metallic_roughness = parameters;
        return out;
    }

  private:
    MetallicRoughness metallic_roughness(const Material& m) {
        MetallicRoughness p;
        p.base_color =
            color({m.base_color[0], m.base_color[1], m.base_color[2]}, m.base_color_texture);
        p.metallic = scalar(m.metallic, m.metallic_roughness_texture, Channel::Blue);
        p.roughness = scalar(m.roughness, m.metallic_roughness_texture, Channel::Green);
        const double occlusion = m.occlusion_texture ? m.occlusion_texture->strength : 1.0;
        p.occlusion = scalar(occlusion, m.occlusion_texture, Channel::Red);
        p.specular = scalar(m.specular, m.specular_texture, Channel::Alpha);
        p.specular_color = color(rgb(m.specular_color), m.specular_color_texture);
        p.transmission = scalar(m.transmission, m.transmission_texture, Channel::Red);
        p.thickness = scalar(m.thickness, m.thickness_texture, Channel::Green);
        if (m.attenuation_distance) p.attenuation_distance = *m.attenuation_distance;
        p.attenuation_color = rgb(m.attenuation_color);
        p.coat.strength = scalar(m.coat, m.coat_texture, Channel::Red);
        p.coat.roughness = scalar(m.coat_roughness, m.coat_roughness_texture, Channel::Green);
        if (m.coat_normal_texture) {
            p.coat.normal_map = {textures_.use(m.coat_normal_texture, ColorSpace::Linear),
                                 m.coat_normal_texture->strength};
        }
        p.sheen.color = color(rgb(m.sheen_color), m.sheen_color_texture);
        p.sheen.roughness = scalar(m.sheen_roughness, m.sheen_roughness_texture, Channel::Alpha);
        p.film.strength = scalar(m.iridescence, m.iridescence_texture, Channel::Red);
        p.film.index = m.film_ior;
        p.film.thinnest_nm = m.film_thinnest;
        p.film.thickest_nm = m.film_thickest;
        p.film.thickness_texture = textures_.use(m.film_thickness_texture, ColorSpace::Linear);
        p.anisotropy = {m.anisotropy, m.anisotropy_rotation,
                        textures_.use(m.anisotropy_texture, ColorSpace::Linear)};
        p.diffuse_transmission = {
            scalar(m.diffuse_transmission, m.diffuse_transmission_texture, Channel::Alpha),
            color(rgb(m.diffuse_transmission_color), m.diffuse_transmission_color_texture)};
        p.dispersion = m.dispersion;
        p.unlit = m.unlit;
        return p;
    }

    /// Converts as KHR_materials_specular and KHR_materials_ior define it: an index of 0 reflects
    /// all light times the specular colour, and the diffuse colour gets the rest.
    void set_specular_glossiness(const SpecularGlossiness& old, MetallicRoughness& p) {
        p.base_color = color({old.diffuse[0], old.diffuse[1], old.diffuse[2]}, old.diffuse_texture);
        p.metallic = {0.0, kNoTexture, Channel::Blue};
        p.specular = {1.0, kNoTexture, Channel::Alpha};
        p.specular_color = color(rgb(old.specular), old.specular_glossiness_texture);
        p.roughness = {1.0 - old.glossiness, kNoTexture, Channel::Green};
        const TextureId of_gloss =
            textures_.use_as_roughness(old.specular_glossiness_texture, old.glossiness);
        if (of_gloss != kNoTexture) p.roughness = {1.0, of_gloss, Channel::Green};
    }

    /// Splits the attenuation into scattering and absorption.
    static void set_scattering(const Material& m, MetallicRoughness& p, VolumeScattering& out) {
        if (!m.attenuation_distance || m.multiscatter == std::array<double, 3>{}) return;
        const Rgb single = single_scatter_albedo(rgb(m.multiscatter));
        out.anisotropy = m.scatter_anisotropy;
        for (int i = 0; i < 3; ++i) {
            // A black channel would attenuate infinitely.
            double& color = p.attenuation_color[i];
            const double left = std::max(color, 1e-12);
            out.coefficient[i] = -single[i] * std::log(left) / *m.attenuation_distance;
            color = std::pow(left, 1.0 - single[i]);
        }
    }

    ColorInput color(const Rgb& factor, const std::optional<TextureInfo>& info) {
        return {factor, textures_.use(info, ColorSpace::Srgb)};
    }
    ScalarInput scalar(double factor, const std::optional<TextureInfo>& info, Channel channel) {
        return {factor, textures_.use(info, ColorSpace::Linear), channel};
    }

    Textures& textures_;
};

}  // namespace

void add_materials(const Document& document, const ImportSource& source, SceneDescription& scene,
                   Diagnostics& diagnostics) {
    Textures textures(document, source, scene, diagnostics);
    MaterialMaker maker(textures);
    for (std::size_t i = 0; i < document.materials.size(); ++i) {
        const Material& material = document.materials[i];
        std::string name = material.name.empty() ? fmt::format("material {}", i) : material.name;
        scene.materials.push_back(
            {maker.make(material, std::move(name)), {source.path.string(), 0, 0}});
    }
}

MaterialId DefaultMaterial::id() {
    if (!id_) {
        id_ = MaterialId{std::uint32_t(scene_.materials.size())};
        alhazen::Material material;
        material.name = "default";
        material.index.value = Material{}.ior;
        material.double_sided = Material{}.double_sided;
        material.metallic_roughness = MetallicRoughness{};
        scene_.materials.push_back({std::move(material), {scene_.path.string(), 0, 0}});
    }
    return *id_;
}

}  // namespace alhazen::gltf
