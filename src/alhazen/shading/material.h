#pragma once
/// The Whitted material: what a point of a surface does with light, constant or read from textures.

#include <cstdint>
#include <span>
#include <string>

#include "alhazen/shading/texture.h"

namespace alhazen {

enum class MaterialId : std::uint32_t {};

/// A colour, or a texture times that colour.
struct ColorInput {
    Rgb color;
    TextureId texture = kNoTexture;
};
/// A number, or the mean of a texture's channels times that number.
struct ScalarInput {
    double value = 0;
    TextureId texture = kNoTexture;
};

/// Coefficients are 0..1 by custom, not by force. Importers fill in what their format leaves out
/// (kr = ks, say) so that renderers need no rules of formats.
struct Material {
    std::string name;
    ColorInput emission;                   ///< ke
    ColorInput ambient;                    ///< ka
    ColorInput diffuse;                    ///< kd
    ColorInput specular;                   ///< ks, the highlight
    ColorInput reflective;                 ///< kr, the mirror direction
    ColorInput transmissive;               ///< kt, the refracted direction
    ScalarInput shininess{0, kNoTexture};  ///< ns, exponent of the highlight
    ScalarInput index{1, kNoTexture};      ///< index of refraction inside the surface's normal

    [[nodiscard]] bool is_opaque() const {
        return transmissive.texture == kNoTexture ? transmissive.color.is_black() : false;
    }
};

/// A material evaluated at one point.
struct MaterialSample {
    Rgb emission, ambient, diffuse, specular, reflective, transmissive;
    double shininess = 0, index = 1;
};

[[nodiscard]] MaterialSample evaluate(const Material& material, std::span<const Texture> textures,
                                      const Vec2& uv);

/// Weighted sum of two samples: vertex materials are interpolated field by field.
[[nodiscard]] MaterialSample weighted_sum(double wa, const MaterialSample& a, double wb,
                                          const MaterialSample& b, double wc,
                                          const MaterialSample& c);

}  // namespace alhazen
