#include "alhazen/shading/materials/material.h"

#include <algorithm>
#include <variant>

#include "alhazen/shading/materials/texture_inputs.h"
#include "alhazen/shading/materials/textures_of.h"

namespace alhazen {

namespace {

Rgba texel_of(const SolidTexture& texture, const SurfaceLookup& lookup) {
    return evaluate(texture, lookup.aperture);
}

Rgba texel_of(const ImageTexture& texture, const SurfaceLookup& lookup) {
    const std::size_t set = texture.uv_set == 1 ? 1 : 0;
    const UvTransform& transform = texture.uv_transform;
    if (transform == UvTransform{}) {
        return evaluate(texture, lookup.uv[set], lookup.footprint[set]);
    }
    return evaluate(
        texture, transform.apply(lookup.uv[set]),
        {transform.linear(lookup.footprint[set].a), transform.linear(lookup.footprint[set].b)});
}

/// True if `is` is true of a texture of the material.
template <class Is>
bool any_texture(const Material& m, const Is& is) {
    const auto any = [&](const auto&... input) {
        return ((input.texture != kNoTexture && is(input.texture)) || ...);
    };
    if (any(m.emission, m.ambient, m.diffuse, m.specular, m.reflective, m.transmissive, m.shininess,
            m.index, m.roughness, m.alpha, m.normal_map)) {
        return true;
    }
    if (!m.metallic_roughness) return false;
    const MetallicRoughness& p = *m.metallic_roughness;
    return any(p.base_color, p.metallic, p.roughness, p.occlusion, p.specular, p.specular_color,
               p.transmission, p.thickness, p.coat.strength, p.coat.roughness, p.coat.normal_map,
               p.sheen.color, p.sheen.roughness, p.film.strength, p.anisotropy,
               p.diffuse_transmission.share, p.diffuse_transmission.color) ||
           (p.film.thickness_texture != kNoTexture && is(p.film.thickness_texture));
}

}  // namespace

Rgba texel_at(TextureId id, std::span<const Texture> textures, const SurfaceLookup& lookup) {
    return std::visit([&](const auto& texture) { return texel_of(texture, lookup); },
                      textures[static_cast<std::uint32_t>(id)]);
}

std::vector<TextureId> textures_of(const Material& m) {
    std::vector<TextureId> all;
    (void)any_texture(m, [&](TextureId texture) {
        all.push_back(texture);
        return false;
    });
    return all;
}

bool reads_textures(const Material& m) {
    return any_texture(m, [](TextureId) { return true; });
}

bool reads_coordinates(const Material& m) {
    return reads_textures(m) || has_grooves(m);
}

bool has_grooves(const Material& m) {
    return m.metallic_roughness && m.metallic_roughness->anisotropy.strength != 0.0;
}

bool has_turned_grooves(const Material& m) {
    if (!has_grooves(m)) return false;
    const Grooves& grooves = m.metallic_roughness->anisotropy;
    return grooves.rotation != 0.0 || grooves.texture != kNoTexture;
}

double channel_of(const Rgba& texel, Channel channel) {
    switch (channel) {
        case Channel::Red:
            return texel.r;
        case Channel::Green:
            return texel.g;
        case Channel::Blue:
            return texel.b;
        case Channel::Alpha:
            return texel.a;
        case Channel::Mean:
            break;
    }
    return (texel.r + texel.g + texel.b) / 3.0;
}

Rgb color_at(const ColorInput& input, std::span<const Texture> textures,
             const SurfaceLookup& lookup) {
    if (input.texture == kNoTexture) return input.color;
    return input.color * texel_at(input.texture, textures, lookup).rgb();
}

double value_at(const ScalarInput& input, std::span<const Texture> textures,
                const SurfaceLookup& lookup) {
    if (input.texture == kNoTexture) return input.value;
    return input.value * channel_of(texel_at(input.texture, textures, lookup), input.channel);
}

double coverage_of(const Material& material, std::span<const Texture> textures,
                   const SurfaceLookup& lookup) {
    if (material.alpha_mode == AlphaMode::Opaque) return 1.0;
    const double alpha = lookup.color.a * value_at(material.alpha, textures, lookup);
    if (material.alpha_mode == AlphaMode::Mask) return alpha < material.alpha_cutoff ? 0.0 : 1.0;
    return alpha > 0.0 ? std::min(alpha, 1.0) : 0.0;
}

namespace {

/// Whitted's coefficients. The sample is constructed in one expression, which is faster than
/// setting the fields one by one.
MaterialSample evaluate_whitted(const Material& m, std::span<const Texture> textures,
                                const SurfaceLookup& lookup) {
    // Ambient and diffuse colours often share a texture: its last value is reused.
    TextureId last = kNoTexture;
    Rgb texel;
    const auto color = [&](const ColorInput& input) {
        if (input.texture == kNoTexture) return input.color;
        if (input.texture != last) texel = texel_at(input.texture, textures, lookup).rgb();
        last = input.texture;
        return input.color * texel;
    };
    const auto value = [&](const ScalarInput& input) {
        return input.texture == kNoTexture ? input.value : value_at(input, textures, lookup);
    };
    const Rgb vertex = lookup.color.rgb();
    const Rgb diffuse = vertex * color(m.diffuse);
    const Rgb ambient = vertex * color(m.ambient);
    return {.emission = color(m.emission),
            .ambient = ambient,
            .diffuse = diffuse,
            .specular = color(m.specular),
            .reflective = color(m.reflective),
            .transmissive = color(m.transmissive),
            .shininess = value(m.shininess),
            .index = value(m.index),
            .roughness = std::clamp(value(m.roughness), 0.0, 1.0),
            .coverage = coverage_of(m, textures, lookup),
            .albedo = diffuse,
            .single_sided = !m.double_sided};
}

}  // namespace

MaterialSample evaluate(const Material& material, std::span<const Texture> textures,
                        const SurfaceLookup& lookup) {
    const bool constants = material.conductor || material.dielectric;
    if (!material.metallic_roughness && !constants) {
        return evaluate_whitted(material, textures, lookup);
    }
    MaterialSample sample =
        material.metallic_roughness
            ? evaluate_metallic_roughness(material, *material.metallic_roughness, textures, lookup)
            : evaluate_physical_constants(material, textures, lookup);
    sample.coverage = coverage_of(material, textures, lookup);
    sample.single_sided = !material.double_sided;
    return sample;
}

MaterialSample weighted_sum(double wa, const MaterialSample& a, double wb, const MaterialSample& b,
                            double wc, const MaterialSample& c) {
    MaterialSample sum = a;
    const auto mix = [&](auto... field) {
        ((sum.*field = wa * (a.*field) + wb * (b.*field) + wc * (c.*field)), ...);
    };
    using S = MaterialSample;
    mix(&S::emission, &S::ambient, &S::diffuse, &S::specular, &S::reflective, &S::transmissive,
        &S::albedo, &S::absorption, &S::grazing);
    mix(&S::shininess, &S::index, &S::roughness, &S::coverage, &S::occlusion);
    return sum;
}

}  // namespace alhazen
