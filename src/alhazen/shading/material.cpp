#include "alhazen/shading/material.h"

namespace alhazen {

namespace {

Rgb color_at(const ColorInput& input, std::span<const Texture> textures, const Vec2& uv) {
    if (input.texture == kNoTexture) return input.color;
    return input.color * evaluate(textures[static_cast<std::uint32_t>(input.texture)], uv);
}

double value_at(const ScalarInput& input, std::span<const Texture> textures, const Vec2& uv) {
    if (input.texture == kNoTexture) return input.value;
    const Rgb c = evaluate(textures[static_cast<std::uint32_t>(input.texture)], uv);
    return input.value * ((c.r + c.g + c.b) / 3.0);
}

}  // namespace

MaterialSample evaluate(const Material& material, std::span<const Texture> textures,
                        const Vec2& uv) {
    return {.emission = color_at(material.emission, textures, uv),
            .ambient = color_at(material.ambient, textures, uv),
            .diffuse = color_at(material.diffuse, textures, uv),
            .specular = color_at(material.specular, textures, uv),
            .reflective = color_at(material.reflective, textures, uv),
            .transmissive = color_at(material.transmissive, textures, uv),
            .shininess = value_at(material.shininess, textures, uv),
            .index = value_at(material.index, textures, uv)};
}

MaterialSample weighted_sum(double wa, const MaterialSample& a, double wb, const MaterialSample& b,
                            double wc, const MaterialSample& c) {
    const auto mix = [&](auto MaterialSample::*field) {
        return wa * (a.*field) + wb * (b.*field) + wc * (c.*field);
    };
    return {.emission = mix(&MaterialSample::emission),
            .ambient = mix(&MaterialSample::ambient),
            .diffuse = mix(&MaterialSample::diffuse),
            .specular = mix(&MaterialSample::specular),
            .reflective = mix(&MaterialSample::reflective),
            .transmissive = mix(&MaterialSample::transmissive),
            .shininess = mix(&MaterialSample::shininess),
            .index = mix(&MaterialSample::index)};
}

}  // namespace alhazen
