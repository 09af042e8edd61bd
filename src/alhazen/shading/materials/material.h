#pragma once
/// What a point of a surface does with light, constant or read from textures: Whitted's
/// coefficients, or the metallic-roughness parameters from which they are derived where they are
/// used.
///
/// BSDFs (evaluation, sampling, density) belong in shading/bsdf/ and are made of the same Material;
/// MaterialSample holds the terms of Whitted's equation.
///
/// Source: Khronos, "glTF 2.0 Specification", 2021, section 3.9 and appendix B; the extensions
/// KHR_materials_{anisotropy, clearcoat, dispersion, emissive_strength, ior, iridescence, sheen,
/// specular, transmission, unlit, volume}.

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>

#include "alhazen/shading/optics/dispersion.h"
#include "alhazen/shading/optics/illuminant.h"
#include "alhazen/shading/textures/texture.h"

namespace alhazen {

enum class MaterialId : std::uint32_t {};

/// A colour, or a texture times that colour.
struct ColorInput {
    Rgb color;
    TextureId texture = kNoTexture;
};
/// Which number of a texel a scalar input reads; Mean is that of red, green and blue.
enum class Channel { Mean, Red, Green, Blue, Alpha };
/// A number, or a channel of a texture times that number.
struct ScalarInput {
    double value = 0;
    TextureId texture = kNoTexture;
    Channel channel = Channel::Mean;
};

/// What alpha means: nothing; a threshold that cuts the surface out; how much of it is there.
enum class AlphaMode { Opaque, Mask, Blend };

/// A picture of directions in the tangent frame that bends the shading normal: x to the right (+u),
/// y up (+v), z along the normal, each stored as (c + 1) / 2.
struct NormalMap {
    TextureId texture = kNoTexture;
    double scale = 1;  ///< of x and y
};

/// A clear layer of index 1.5 over all else.
struct ClearCoat {
    ScalarInput strength{0, kNoTexture, Channel::Red};
    ScalarInput roughness{0, kNoTexture, Channel::Green};
    NormalMap normal_map;
};
/// Fibres that stand off the surface.
struct SheenLayer {
    ColorInput color{{0, 0, 0}, kNoTexture};
    ScalarInput roughness{0, kNoTexture, Channel::Alpha};
};
/// A film whose two sides interfere. A texture of the thickness blends from `thinnest` to
/// `thickest`; without one it is `thickest`.
struct IridescentFilm {
    ScalarInput strength{0, kNoTexture, Channel::Red};
    double index = 1.3;
    double thinnest_nm = 100, thickest_nm = 400;
    TextureId thickness_texture = kNoTexture;  ///< its green channel
};
/// Grooves along a direction in the surface: `rotation` (radians) from the tangent to the
/// bitangent. Red and green of the texture turn it further, blue times `strength`.
struct Grooves {
    double strength = 0, rotation = 0;
    TextureId texture = kNoTexture;
};

/// Light that a matt body lets out on its other side: a leaf, paper, wax. `share` of what the body
/// scatters, tinted by `color` in place of the base colour.
struct DiffuseTransmission {
    ScalarInput share{0, kNoTexture, Channel::Alpha};
    ColorInput color{{1, 1, 1}, kNoTexture};
};

/// The metallic-roughness parameters, kept as the file gives them. Emission and index of refraction
/// are those of the Material.
struct MetallicRoughness {
    ColorInput base_color{{1, 1, 1}, kNoTexture};
    ScalarInput metallic{1, kNoTexture, Channel::Blue};
    ScalarInput roughness{1, kNoTexture, Channel::Green};
    /// 1 where no texture; a texture is blended in by `value`: 1 + value (texel - 1).
    ScalarInput occlusion{1, kNoTexture, Channel::Red};
    ScalarInput specular{1, kNoTexture, Channel::Alpha};  ///< strength of the dielectric reflection
    ColorInput specular_color{{1, 1, 1}, kNoTexture};     ///< of it at normal incidence
    ScalarInput transmission{0, kNoTexture, Channel::Red};
    /// 0: a thin sheet that does not bend light; else the surface bounds a volume.
    ScalarInput thickness{0, kNoTexture, Channel::Green};
    double attenuation_distance = std::numeric_limits<double>::infinity();  ///< scene units
    Rgb attenuation_color{1, 1, 1};  ///< what is left of white light after that distance
    ClearCoat coat;
    SheenLayer sheen;
    IridescentFilm film;
    Grooves anisotropy;
    DiffuseTransmission diffuse_transmission;
    double dispersion = 0;  ///< 20 / Abbe number; seen by renderers of wavelengths alone
    bool unlit = false;     ///< shows its base colour whatever the light
};

/// A metal by its complex index of refraction n + i k at red, green and blue.
struct Conductor {
    Rgb index, extinction;
    std::string name;  ///< of a measured metal (metals.h); empty: by the numbers
};
/// A clear body that reflects and refracts by Fresnel's equations. Its index is the Material's.
struct Dielectric {
    Rgb absorption;  ///< inside: light falls by exp(-absorption * length)
};

/// What scatters light inside a volume, the same everywhere.
///
/// Source: Henyey and Greenstein, "Diffuse Radiation in the Galaxy", Astrophysical Journal 93,
/// 1941.
struct VolumeScattering {
    Rgb coefficient;        ///< light is scattered by this share in a unit of length; black: none
    double anisotropy = 0;  ///< mean cosine of the angle by which it turns, in (-1, 1)
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
    /// How `index`, which is that of line d, depends on the wavelength; none: not at all.
    std::optional<Dispersion> dispersion;
    /// Given: the spectrum of the emission, whose colour is that of `emission`.
    std::optional<Illuminant> illuminant;
    /// 0..1: how far reflected and refracted rays spread, for renderers in which they do.
    ScalarInput roughness{0, kNoTexture};

    /// Mass of a unit of volume, in any unit; for measures, not for light.
    std::optional<double> density;

    AlphaMode alpha_mode = AlphaMode::Opaque;
    ScalarInput alpha{1, kNoTexture, Channel::Alpha};  ///< times the alpha of the vertex colour
    double alpha_cutoff = 0.5;                         ///< Mask: below it nothing is there
    bool double_sided = true;                          ///< else the back cannot be seen
    NormalMap normal_map;
    /// Given: the Whitted coefficients above (emission and index apart) are not used; `evaluate`
    /// derives them.
    std::optional<MetallicRoughness> metallic_roughness;
    /// Given: the same, of a surface by its physical constants. `roughness` is that of the
    /// Material.
    std::optional<Conductor> conductor;
    std::optional<Dielectric> dielectric;
    /// Of the volume inside, where the surface bounds one. For renderers that follow light.
    VolumeScattering scattering;

    /// True when no light passes anywhere.
    [[nodiscard]] bool is_opaque() const {
        const auto is_black = [](const ColorInput& c) {
            return c.texture == kNoTexture && c.color.is_black();
        };
        if (alpha_mode != AlphaMode::Opaque) return false;
        if (conductor || dielectric) return !dielectric;
        return metallic_roughness ? metallic_roughness->transmission.value == 0.0
                                  : is_black(transmissive);
    }
};

/// What a material may look at where a ray meets it.
struct SurfaceLookup {
    std::array<Vec2, 2> uv{};  ///< both sets of texture coordinates
    std::array<UvFootprint, 2> footprint{};
    Rgba color{1, 1, 1, 1};  ///< of the vertices
    SolidAperture aperture;  ///< in world space
};

/// A material evaluated at one point, as the terms of Whitted's equation and what it leaves out.
/// Colours are those at normal incidence until `turn_to_view`.
struct MaterialSample {
    Rgb emission, ambient, diffuse, specular, reflective, transmissive;
    double shininess = 0, index = 1;
    double roughness = 0;  ///< of the directions of rays; 0: exact

    double coverage = 1;   ///< share of the point that is there; a ray goes straight on by the rest
    Rgb albedo;            ///< colour of the surface itself, whatever it does with it
    Rgb absorption;        ///< inside: light falls by exp(-absorption * length)
    double occlusion = 1;  ///< already in `ambient`
    bool unlit = false;    ///< the colour is in `emission`; all else is black
    bool thin = false;     ///< transmitted light goes straight on, and inside is outside
    bool physical = false;      ///< metallic-roughness: the highlight is times N.L, Fresnel applies
    Rgb grazing;                ///< `reflective` at grazing incidence, where physical
    bool single_sided = false;  ///< cannot be seen from behind
};

[[nodiscard]] MaterialSample evaluate(const Material& material, std::span<const Texture> textures,
                                      const SurfaceLookup& lookup);
[[nodiscard]] inline MaterialSample evaluate(const Material& material,
                                             std::span<const Texture> textures, const Vec2& uv) {
    return evaluate(material, textures, SurfaceLookup{{uv, uv}, {}, {1, 1, 1, 1}, {}});
}

/// A volume is seen from inside whatever its sides; a thin sheet is not.
[[nodiscard]] inline bool is_unseen_from_behind(const MaterialSample& sample) {
    return sample.single_sided && (sample.thin || sample.transmissive.is_black());
}

/// What part of the point is there, without the rest of the material.
[[nodiscard]] double coverage_of(const Material& material, std::span<const Texture> textures,
                                 const SurfaceLookup& lookup);

/// Makes a physical sample that of a ray that meets the surface with `cosine` to its normal (0..1),
/// from inside the volume or not: Schlick's Fresnel term, total reflection included, shared out
/// between reflection and the rest. Does nothing to others.
void turn_to_view(MaterialSample& sample, double cosine, bool from_inside);

/// Weighted sum of two samples: vertex materials are interpolated field by field, what is only true
/// or false is the first one's.
[[nodiscard]] MaterialSample weighted_sum(double wa, const MaterialSample& a, double wb,
                                          const MaterialSample& b, double wc,
                                          const MaterialSample& c);

}  // namespace alhazen
