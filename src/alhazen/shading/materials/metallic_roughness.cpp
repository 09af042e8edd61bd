/// Metallic-roughness parameters as terms of Whitted's equation.
///
/// Source: Khronos, "glTF 2.0 Specification", 2021, appendix B; Schlick, "An Inexpensive BRDF Model
/// for Physically-Based Rendering", Eurographics 1994; Walter et al., "Microfacet Models for
/// Refraction through Rough Surfaces", EGSR 2007 (the Blinn-Phong exponent of a roughness).
/// Differs: docs/reference/materials.md, with the reasons.

#include <algorithm>
#include <cmath>

#include "alhazen/shading/materials/texture_inputs.h"
#include "alhazen/shading/materials/turn_to_view.h"
#include "alhazen/shading/optics/fresnel.h"

namespace alhazen {

namespace {

/// Least roughness of a highlight: a narrower one would fall between the pixels.
constexpr double kLeastRoughness = 0.2;

double clamped(double x) {
    return x > 0.0 ? std::min(x, 1.0) : 0.0;
}

double fifth_power(double x) {
    return x * x * x * x * x;
}

double max_of_one(const Rgb& c) {
    return clamped(c.max());
}

Rgb min_of_one(const Rgb& c) {
    return {clamped(c.r), clamped(c.g), clamped(c.b)};
}

/// Absorption coefficient sigma of exp(-sigma length) with transmittance `color` at `distance`.
Rgb absorption_of(const Rgb& color, double distance) {
    if (!(distance > 0.0) || !std::isfinite(distance)) return {};
    const auto sigma = [&](double c) {
        // Channels are at least 1e-12: 0 would give infinite absorption.
        return -std::log(std::clamp(c, 1e-12, 1.0)) / distance;
    };
    return {sigma(color.r), sigma(color.g), sigma(color.b)};
}

/// Reflectance of a boundary at normal incidence.
double normal_reflectance(double index) {
    // KHR_materials_ior: index 0 stands for infinity: all light is reflected.
    if (index == 0.0) return 1.0;
    const double r = (index - 1.0) / (index + 1.0);
    return r * r;
}

/// Share of the reflection that stays sharp.
double mirror_share(double roughness) {
    return std::pow(1.0 - roughness, 4.0);
}

/// Scales the terms below the reflection by the share that is not reflected.
void keep_below(MaterialSample& sample, double share) {
    sample.diffuse = share * sample.diffuse;
    sample.transmissive = share * sample.transmissive;
}

/// Replaces the reflectance against index 1 by that of a boundary of relative index `eta`.
void set_reflectance_of_wall(double eta, MaterialSample& sample) {
    const double between = normal_reflectance(eta);
    if (const double outside = normal_reflectance(sample.index); outside > 0.0) {
        const double share = between / outside;
        sample.reflective = share * sample.reflective;
        sample.specular = share * sample.specular;
        return;
    }
    // A material of index 1 has no reflectance to be scaled: it starts from that at grazing
    // incidence, which is M times its strength.
    const Rgb missing = between * (sample.grazing - sample.reflective);
    sample.reflective += missing;
    const double mirror = mirror_share(sample.roughness);
    if (mirror > 0.0) sample.specular += (sample.shininess + 2.0) / (8.0 * mirror) * missing;
}

}  // namespace

MaterialSample evaluate_metallic_roughness(const Material& material, const MetallicRoughness& p,
                                           std::span<const Texture> textures,
                                           const SurfaceLookup& lookup) {
    MaterialSample s;
    // Tests for a texture inline, since most inputs have none.
    const auto color = [&](const ColorInput& input) {
        return input.texture == kNoTexture ? input.color : color_at(input, textures, lookup);
    };
    const Rgb base = lookup.color.rgb() * color(p.base_color);
    s.albedo = base;
    if (p.unlit) {
        s.unlit = true;
        s.emission = base;
        return s;
    }
    const double metallic = clamped(value_at(p.metallic, textures, lookup));
    const double roughness = clamped(value_at(p.roughness, textures, lookup));
    const double strength = clamped(value_at(p.specular, textures, lookup));
    const double transmission = clamped(value_at(p.transmission, textures, lookup));
    if (p.occlusion.texture != kNoTexture) {
        const double texel =
            channel_of(texel_at(p.occlusion.texture, textures, lookup), p.occlusion.channel);
        s.occlusion = clamped(1.0 + p.occlusion.value * (texel - 1.0));
    }
    s.physical = true;
    s.index = value_at(material.index, textures, lookup);
    s.emission = color(material.emission);

    const Rgb dielectric =
        strength * min_of_one(normal_reflectance(s.index) * color(p.specular_color));
    const Rgb at_normal = (1.0 - metallic) * dielectric + metallic * base;
    const double grazing = (1.0 - metallic) * strength + metallic;
    const double mirror = mirror_share(roughness);
    s.reflective = mirror * at_normal;
    s.grazing = mirror * Rgb{grazing, grazing, grazing};

    s.roughness = std::clamp(roughness, 0.0, 1.0);
    const double alpha = std::pow(std::max(roughness, kLeastRoughness), 2.0);
    s.shininess = 2.0 / (alpha * alpha) - 2.0;
    s.specular = (s.shininess + 2.0) / 8.0 * at_normal;

    // Whitted's equation has no light from behind: diffuse transmission is shaded as reflection.
    const double through = clamped(value_at(p.diffuse_transmission.share, textures, lookup));
    Rgb matt = base;
    if (through > 0.0) {
        matt = (1.0 - through) * base + through * color(p.diffuse_transmission.color);
    }
    const Rgb body = (1.0 - metallic) * (1.0 - transmission) * matt;
    // Whitted's equation has no blurred reflection: the share of a metal's reflection that is not
    // mirrored becomes ambient, and half of it diffuse (the highlight has the other half).
    const Rgb rough_metal = metallic * (1.0 - mirror) * base;
    s.diffuse = body + 0.5 * rough_metal;
    s.ambient = s.occlusion * (body + rough_metal);
    s.transmissive = (1.0 - metallic) * transmission * base;
    // The texture of the thickness is ignored: rays find the real thickness of the volume.
    s.thin = !(p.thickness.value > 0.0) || s.index == 0.0;
    if (!s.thin) s.absorption = absorption_of(p.attenuation_color, p.attenuation_distance);
    return s;
}

MaterialSample evaluate_physical_constants(const Material& material,
                                           std::span<const Texture> textures,
                                           const SurfaceLookup& lookup) {
    MetallicRoughness p;
    p.roughness = material.roughness;
    if (material.conductor) {
        const Conductor& c = *material.conductor;
        for (int i = 0; i < 3; ++i) {
            p.base_color.color[i] = conductor_reflectance(1.0, c.index[i], c.extinction[i]);
        }
        return evaluate_metallic_roughness(material, p, textures, lookup);
    }
    p.metallic.value = 0;
    p.transmission.value = p.thickness.value = 1;
    MaterialSample sample = evaluate_metallic_roughness(material, p, textures, lookup);
    sample.absorption = material.dielectric->absorption;
    return sample;
}

void turn_to_view(MaterialSample& sample, double cosine, bool from_inside) {
    const bool dense = from_inside && sample.index > 0.0;
    turn_to_view_between(sample, cosine, dense ? sample.index : 1.0, false);
}

void keep_below_reflection(MaterialSample& sample) {
    keep_below(sample, 1.0 - max_of_one(sample.reflective));
}

void turn_to_view_between(MaterialSample& sample, double cosine, double eta, bool wall,
                          double exact) {
    if (!sample.physical) return;
    if (wall) set_reflectance_of_wall(eta, sample);
    double c = clamped(cosine);
    if (eta > 1.0 && !sample.thin) {
        // Schlick's formula takes the angle on the side of the lower index; beyond the critical
        // angle there is none.
        const double squared = 1.0 - eta * eta * (1.0 - c * c);
        if (!(squared > 0.0)) {
            if (!sample.transmissive.is_black()) sample.reflective = {1, 1, 1};
            keep_below(sample, 0.0);
            return;
        }
        c = std::sqrt(squared);
    }
    double weight = fifth_power(1.0 - c);
    if (exact > 0.0) {
        const double f0 = normal_reflectance(eta);
        const double f = dielectric_reflectance(clamped(cosine), eta);
        weight += exact * ((f0 < 1.0 ? (f - f0) / (1.0 - f0) : 0.0) - weight);
    }
    sample.reflective += weight * (sample.grazing - sample.reflective);
    keep_below_reflection(sample);
}

}  // namespace alhazen
