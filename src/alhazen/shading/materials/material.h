#pragma once
/// How a point of a surface scatters light, constant or read from textures: Whitted's coefficients,
/// the metallic-roughness parameters, or physical constants. `evaluate` derives the terms of
/// Whitted's equation (MaterialSample) from any of them.
///
/// BSDFs (evaluation, sampling, density) are in shading/bsdf/ and are made from the same Material.
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
/// The channel of a texel that a scalar input reads; Mean is the mean of red, green and blue.
enum class Channel { Mean, Red, Green, Blue, Alpha };
/// A number, or a channel of a texture times that number.
struct ScalarInput {
    double value = 0;
    TextureId texture = kNoTexture;
    Channel channel = Channel::Mean;
};

/// Meaning of alpha: ignored; compared with a threshold that cuts the surface out; coverage.
enum class AlphaMode { Opaque, Mask, Blend };

/// A texture of directions in the tangent frame that perturbs the shading normal: x to the right
/// (+u), y up (+v), z along the normal, each stored as (c + 1) / 2.
struct NormalMap {
    TextureId texture = kNoTexture;
    double scale = 1;  ///< factor on x and y
};

/// A clear layer of index 1.5 on top.
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
/// A thin film with interference. A texture of the thickness blends from `thinnest` to `thickest`;
/// without one the thickness is `thickest`.
struct IridescentFilm {
    ScalarInput strength{0, kNoTexture, Channel::Red};
    double index = 1.3;
    double thinnest_nm = 100, thickest_nm = 400;
    TextureId thickness_texture = kNoTexture;  ///< texture of the thickness, its green channel
};
/// Anisotropy: grooves along a direction in the surface, at angle `rotation` (radians) from the
/// tangent to the bitangent. Red and green of the texture rotate it further, blue scales
/// `strength`.
struct Grooves {
    double strength = 0, rotation = 0;
    TextureId texture = kNoTexture;
};

/// Diffuse transmission, as of a leaf, paper, wax. `share` of the light that the body scatters
/// leaves on the other side, tinted by `color` in place of the base colour.
struct DiffuseTransmission {
    ScalarInput share{0, kNoTexture, Channel::Alpha};
    ColorInput color{{1, 1, 1}, kNoTexture};
};

/// The metallic-roughness parameters as given by the file. Emission and index of refraction are
/// those of the Material.
struct MetallicRoughness {
    ColorInput base_color{{1, 1, 1}, kNoTexture};
    ScalarInput metallic{1, kNoTexture, Channel::Blue};
    ScalarInput roughness{1, kNoTexture, Channel::Green};
    /// 1 without a texture; a texel is applied as 1 + value (texel - 1).
    ScalarInput occlusion{1, kNoTexture, Channel::Red};
    ScalarInput specular{1, kNoTexture, Channel::Alpha};  ///< strength of the dielectric reflection
    ColorInput specular_color{{1, 1, 1}, kNoTexture};     ///< its colour at normal incidence
    ScalarInput transmission{0, kNoTexture, Channel::Red};
    /// 0: a thin sheet that does not bend light; else the surface bounds a volume.
    ScalarInput thickness{0, kNoTexture, Channel::Green};
    double attenuation_distance = std::numeric_limits<double>::infinity();  ///< scene units
    Rgb attenuation_color{1, 1, 1};  ///< transmittance at that distance
    ClearCoat coat;
    SheenLayer sheen;
    IridescentFilm film;
    Grooves anisotropy;
    DiffuseTransmission diffuse_transmission;
    double dispersion = 0;  ///< 20 / Abbe number; used by spectral renderers only
    bool unlit = false;     ///< shows its base colour, unaffected by light
};

/// A metal by its complex index of refraction n + i k at red, green and blue.
struct Conductor {
    Rgb index, extinction;
    std::string name;  ///< a measured metal (metals.h); empty: given by `index`, `extinction`
};
/// A clear body with Fresnel reflection and refraction. Its index is that of the Material.
struct Dielectric {
    Rgb absorption;  ///< coefficient inside, per scene unit
};

/// A homogeneous scattering medium inside a volume.
///
/// Source: Henyey and Greenstein, "Diffuse Radiation in the Galaxy", Astrophysical Journal 93,
/// 1941.
struct VolumeScattering {
    Rgb coefficient;        ///< scattering coefficient, per scene unit; black: none
    double anisotropy = 0;  ///< mean cosine of the scattering angle, in (-1, 1)
};

/// Coefficients are 0..1 by convention; larger values are accepted. Importers fill in the defaults
/// of their format (for example kr = ks), so that renderers are independent of formats.
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
    /// Dispersion; `index` is then the index at line d. Empty: the same index at all wavelengths.
    std::optional<Dispersion> dispersion;
    /// Spectrum of the emission, whose colour is `emission`; empty: white light of that colour.
    std::optional<Illuminant> illuminant;
    /// 0..1: spread of reflected and refracted rays, for renderers that support it.
    ScalarInput roughness{0, kNoTexture};

    /// Mass per unit of volume, in any unit; used for mass properties, not for shading.
    std::optional<double> density;

    AlphaMode alpha_mode = AlphaMode::Opaque;
    ScalarInput alpha{1, kNoTexture, Channel::Alpha};  ///< times the alpha of the vertex colour
    double alpha_cutoff = 0.5;                         ///< Mask: below it the surface is cut out
    bool double_sided = true;                          ///< false: the back is invisible
    NormalMap normal_map;
    /// If given, replaces the Whitted coefficients above except emission and index; `evaluate`
    /// converts it.
    std::optional<MetallicRoughness> metallic_roughness;
    /// If given, likewise; physical constants of a metal. `roughness` is that of the Material.
    std::optional<Conductor> conductor;
    std::optional<Dielectric> dielectric;
    /// Medium inside, if the surface bounds a volume; for renderers that trace paths of light.
    VolumeScattering scattering;

    /// True if no light passes anywhere.
    [[nodiscard]] bool is_opaque() const {
        const auto is_black = [](const ColorInput& c) {
            return c.texture == kNoTexture && c.color.is_black();
        };
        if (alpha_mode != AlphaMode::Opaque) return false;
        if (conductor || dielectric) return !dielectric;
        return metallic_roughness ? metallic_roughness->transmission.value == 0.0
                                  : is_black(transmissive);
    }
    /// True if rays may pass points of the surface: it is cut out, blended or seen from its front
    /// alone.
    [[nodiscard]] bool may_be_passed() const {
        return alpha_mode != AlphaMode::Opaque || !double_sided;
    }
};

/// Inputs of `evaluate` at a hit.
struct SurfaceLookup {
    std::array<Vec2, 2> uv{};  ///< the two sets of texture coordinates
    std::array<UvFootprint, 2> footprint{};
    Rgba color{1, 1, 1, 1};  ///< vertex colour
    SolidAperture aperture;  ///< in world space
};

/// A material evaluated at one point: the terms of Whitted's equation and additional properties.
/// Colours are those at normal incidence until `turn_to_view`.
struct MaterialSample {
    Rgb emission, ambient, diffuse, specular, reflective, transmissive;
    double shininess = 0, index = 1;
    double roughness = 0;  ///< spread of reflected and refracted rays; 0: none

    double coverage = 1;        ///< opacity of the point; the rest of a ray goes straight on
    Rgb albedo;                 ///< base colour of the surface, for output
    Rgb absorption;             ///< coefficient inside, per scene unit
    double occlusion = 1;       ///< already in `ambient`
    bool unlit = false;         ///< the colour is in `emission`; all else is black
    bool thin = false;          ///< transmitted light goes straight on; there is no inside
    bool physical = false;      ///< physical model: highlight times N.L, Fresnel applies
    Rgb grazing;                ///< `reflective` at grazing incidence, if physical
    bool single_sided = false;  ///< invisible from behind
};

[[nodiscard]] MaterialSample evaluate(const Material& material, std::span<const Texture> textures,
                                      const SurfaceLookup& lookup);
[[nodiscard]] inline MaterialSample evaluate(const Material& material,
                                             std::span<const Texture> textures, const Vec2& uv) {
    return evaluate(material, textures, SurfaceLookup{{uv, uv}, {}, {1, 1, 1, 1}, {}});
}

/// True if a hit from behind is ignored. The back of a volume is always visible, that of a thin
/// sheet is not.
[[nodiscard]] inline bool is_unseen_from_behind(const MaterialSample& sample) {
    return sample.single_sided && (sample.thin || sample.transmissive.is_black());
}

/// The coverage (see MaterialSample), without the other terms.
[[nodiscard]] double coverage_of(const Material& material, std::span<const Texture> textures,
                                 const SurfaceLookup& lookup);

/// Applies Schlick's Fresnel term, including total reflection, to a physical sample for a ray with
/// `cosine` (0..1) to the normal, outside or inside the volume; the light that is not reflected is
/// left to the other terms. Other samples are unchanged.
void turn_to_view(MaterialSample& sample, double cosine, bool from_inside);

/// Weighted sum of two samples, for vertex materials: numbers are interpolated, boolean fields are
/// those of the first.
[[nodiscard]] MaterialSample weighted_sum(double wa, const MaterialSample& a, double wb,
                                          const MaterialSample& b, double wc,
                                          const MaterialSample& c);

}  // namespace alhazen
