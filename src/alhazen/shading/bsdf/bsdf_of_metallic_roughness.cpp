/// The metallic-roughness model of glTF as lobes.
///
/// Source: Khronos, "glTF 2.0 Specification", 2021, appendix B, and the KHR_materials extensions.
/// Differs: docs/reference/materials.md.

#include <algorithm>
#include <cmath>

#include "alhazen/shading/bsdf/bsdf_of.h"
#include "alhazen/shading/materials/texture_inputs.h"
#include "alhazen/shading/optics/fresnel.h"

namespace alhazen {

namespace {

/// NaN gives 0.
double clipped(double x) {
    return x > 0.0 ? std::min(x, 1.0) : 0.0;
}
Rgb clipped(const Rgb& c) {
    return {clipped(c.r), clipped(c.g), clipped(c.b)};
}

/// Builds the lobes of one surface from its layers, from the top layer to the bottom.
class LayerMaker {
  public:
    LayerMaker(const Material& m, const MetallicRoughness& p, std::span<const Texture> textures,
               const SurfaceLookup& lookup, const BsdfPlace& place)
        : m_(m), p_(p), textures_(textures), lookup_(lookup), place_(place) {}

    [[nodiscard]] Bsdf make() {
        metallic_ = scalar(p_.metallic);
        transmission_ = scalar(p_.transmission);
        roughness_ = scalar(p_.roughness);
        base_ = place_.waves.reflectance(
            clipped(lookup_.color.rgb() * color_at(p_.base_color, textures_, lookup_)));
        add_coat();
        add_sheen();
        read_grooves();
        read_film();
        if (metallic_ > 0.0) {
            bsdf_.add(grey(metallic_), face_lobe({base_, Spectrum::all(1)}), covers_);
        }
        if (metallic_ < 1.0) add_dielectric();
        return bsdf_;
    }

  private:
    [[nodiscard]] double scalar(const ScalarInput& input) const {
        return clipped(value_at(input, textures_, lookup_));
    }
    [[nodiscard]] static Spectrum grey(double x) { return Spectrum::all(x); }

    void add_coat() {
        if (place_.without_coat) return;
        const std::optional<CoatLayer> coat = coat_of(m_, textures_, lookup_);
        if (!coat) return;
        bsdf_.add(coat->bsdf, 1.0);
        covers_ |= bsdf_.add_cover(coat->cover);
    }

    void add_sheen() {
        const Rgb color = clipped(color_at(p_.sheen.color, textures_, lookup_));
        if (color.is_black()) return;
        const double roughness = scalar(p_.sheen.roughness);
        bsdf_.add(grey(1), Sheen{place_.waves.reflectance(color), roughness}, covers_);
        covers_ |= bsdf_.add_cover(Cover::sheen(roughness, color.max()));
    }

    void read_grooves() {
        double strength = p_.anisotropy.strength, angle = p_.anisotropy.rotation;
        if (p_.anisotropy.texture != kNoTexture) {
            const Rgb texel = texel_at(p_.anisotropy.texture, textures_, lookup_).rgb();
            strength *= texel.b;
            const double x = 2.0 * texel.r - 1.0, y = 2.0 * texel.g - 1.0;
            if (x != 0.0 || y != 0.0) angle += std::atan2(y, x);
        }
        strength = clipped(strength);
        const double alpha = roughness_ * roughness_;
        ggx_ = {alpha + (1.0 - alpha) * strength * strength, alpha};
        if (!(strength > 0.0)) return;
        axis_ = {std::cos(angle), place_.mirrored ? -std::sin(angle) : std::sin(angle)};
    }

    void read_film() {
        film_share_ = scalar(p_.film.strength);
        if (!(film_share_ > 0.0)) return;
        double share = 1.0;
        if (p_.film.thickness_texture != kNoTexture) {
            share = texel_at(p_.film.thickness_texture, textures_, lookup_).g;
        }
        film_nm_ = p_.film.thinnest_nm + share * (p_.film.thickest_nm - p_.film.thinnest_nm);
        if (!(film_nm_ > 0.0)) film_share_ = 0.0;
    }

    [[nodiscard]] FresnelTerm term(const SchlickTerm& base) const {
        if (!(film_share_ > 0.0)) return base;
        return FilmTerm{base, film_share_, p_.film.index, film_nm_, place_.waves.all_nm()};
    }
    [[nodiscard]] Lobe face_lobe(const SchlickTerm& base) const {
        if (ggx_.x < kSmoothAlpha) return Mirror{term(base)};
        return RoughReflection(ggx_, term(base), axis_);
    }
    /// Attenuation by the face, the same at all wavelengths. A film's colours depend on the angle:
    /// the largest channel is used, so that energy is lost rather than gained.
    [[nodiscard]] Cover face_cover(const Rgb& f0, double f90) const {
        double most = f0.max();
        if (film_share_ > 0.0) {
            const SchlickTerm base{kColorChannels.reflectance(f0), grey(f90)};
            for (const double cosine : {1.0, 0.8, 0.6, 0.4, 0.2}) {
                const FilmTerm film{base, film_share_, p_.film.index, film_nm_, {}};
                most = std::max(most, schlick_fit(film, cosine).f0.max());
            }
            f90 = 1.0;
        }
        return Cover::face(ggx_, axis_, most, f90);
    }

    void add_dielectric() {
        const double strength = scalar(p_.specular);
        const Rgb tint = not_negative_color(p_.specular_color);
        // KHR_materials_ior: index 0 stands for infinity: all light is reflected.
        const double index = value_at(m_.index, textures_, lookup_);
        const bool reflects_all = index == 0.0;
        const double at_normal = reflects_all ? 1.0 : normal_reflectance_of(index);
        const Rgb f0 = strength * clipped(at_normal * tint);
        const SchlickTerm fresnel{place_.waves.reflectance(f0), grey(strength)};
        const double share = 1.0 - metallic_;
        const bool thin = !(p_.thickness.value > 0.0) || reflects_all;
        const double matt = share * (1.0 - transmission_), clear = share * transmission_;

        // The film is omitted from inside: light beyond the critical angle must be reflected.
        const bool filmed = film_share_ > 0.0 && !place_.from_inside;
        const double faces = thin || filmed ? share : matt;
        if (faces > 0.0) bsdf_.add(grey(faces), face_lobe(fresnel), covers_);
        if (f0.max() >= 1.0) return;  // no light passes the face
        const Cover cover = face_cover(f0, strength);
        add_body(matt, cover);
        if (!(clear > 0.0)) return;
        if (thin || filmed) {
            // The face covers the transmission as it does the matt body.
            const CoverSet below = covers_ | bsdf_.add_cover(cover);
            if (!thin) {
                bsdf_.add(grey(clear), boundary_lobe(roughness_, place_, index, {}, base_), below);
            } else if (ggx_.x < kSmoothAlpha) {
                bsdf_.add(grey(clear), ThinSheet{base_}, below);
            } else {
                bsdf_.add(clear * base_, RoughSheet(ggx_, axis_), below);
            }
            return;
        }
        bsdf_.add(grey(clear),
                  boundary_lobe(roughness_, place_, index,
                                place_.waves.reflectance(strength * clipped(tint)), base_),
                  covers_);
    }

    /// The matt body below a face: diffuse reflection and diffuse transmission.
    void add_body(double share, const Cover& cover) {
        const double through = scalar(p_.diffuse_transmission.share);
        bsdf_.add(grey(share * (1.0 - through)), CoveredMatt(base_, cover), covers_);
        if (!(share * through > 0.0)) return;
        const Rgb color = clipped(color_at(p_.diffuse_transmission.color, textures_, lookup_));
        bsdf_.add(grey(share * through), LambertTransmission{place_.waves.reflectance(color)},
                  covers_ | bsdf_.add_cover(cover));
    }

    [[nodiscard]] Rgb not_negative_color(const ColorInput& input) const {
        const Rgb c = color_at(input, textures_, lookup_);
        return {c.r > 0.0 ? c.r : 0.0, c.g > 0.0 ? c.g : 0.0, c.b > 0.0 ? c.b : 0.0};
    }

    const Material& m_;
    const MetallicRoughness& p_;
    std::span<const Texture> textures_;
    const SurfaceLookup& lookup_;
    const BsdfPlace& place_;
    Bsdf bsdf_;
    CoverSet covers_ = 0;  ///< covers of the layers above
    double metallic_ = 0, transmission_ = 0, roughness_ = 1;
    Spectrum base_;
    Ggx ggx_;
    Vec2 axis_{1, 0};
    double film_share_ = 0, film_nm_ = 0;
};

}  // namespace

std::optional<CoatLayer> coat_of(const Material& material, std::span<const Texture> textures,
                                 const SurfaceLookup& lookup) {
    if (!material.metallic_roughness || material.metallic_roughness->unlit) return std::nullopt;
    const ClearCoat& coat = material.metallic_roughness->coat;
    const double strength = clipped(value_at(coat.strength, textures, lookup));
    if (!(strength > 0.0)) return std::nullopt;
    const double roughness = clipped(value_at(coat.roughness, textures, lookup));
    CoatLayer layer;
    layer.bsdf.add(Spectrum::all(strength),
                   reflection_lobe(roughness, SchlickTerm{Spectrum::all(0.04), Spectrum::all(1)}));
    layer.cover = Cover::face(roughness * roughness, 0.04, 1.0, strength);
    return layer;
}

Bsdf bsdf_of_metallic_roughness(const Material& material, const MetallicRoughness& parameters,
                                std::span<const Texture> textures, const SurfaceLookup& lookup,
                                const BsdfPlace& place) {
    if (parameters.unlit) return {};
    return LayerMaker(material, parameters, textures, lookup, place).make();
}

}  // namespace alhazen
