#include "alhazen/shading/bsdf/bsdf_of.h"

#include <algorithm>
#include <cmath>

#include "alhazen/shading/materials/texture_inputs.h"
#include "alhazen/shading/optics/fresnel.h"
#include "alhazen/shading/optics/metals.h"

namespace alhazen {

double eta_at(const BsdfPlace& place, double index) {
    if (place.eta > 0.0) return place.eta;
    const double n = index > 0.0 && std::isfinite(index) ? index : 1.0;
    return place.from_inside ? n : 1.0 / n;
}

namespace {

std::optional<Spectrum> etas_at(const BsdfPlace& place) {
    return place.etas != nullptr ? std::optional(*place.etas) : std::nullopt;
}

}  // namespace

Lobe reflection_lobe(double roughness, const FresnelTerm& fresnel) {
    const double alpha = roughness * roughness;
    if (alpha < kSmoothAlpha) return Mirror{fresnel};
    return RoughReflection({alpha, alpha}, fresnel);
}

Lobe boundary_lobe(double roughness, const BsdfPlace& place, double index,
                   const Spectrum& reflection, const Spectrum& transmission) {
    const double alpha = roughness * roughness;
    const double eta = eta_at(place, index);
    if (alpha < kSmoothAlpha || std::abs(eta - 1.0) < 1e-3) {
        return SmoothDielectric{eta, reflection, transmission, true, etas_at(place)};
    }
    return RoughDielectric(alpha, eta, reflection, transmission);
}

namespace {

Rgb not_negative(const Rgb& c) {
    return {c.r > 0.0 ? c.r : 0.0, c.g > 0.0 ? c.g : 0.0, c.b > 0.0 ? c.b : 0.0};
}

double roughness_of(const Material& m, std::span<const Texture> textures,
                    const SurfaceLookup& lookup) {
    const double roughness = value_at(m.roughness, textures, lookup);
    return roughness > 0.0 ? std::min(roughness, 1.0) : 0.0;
}

/// Lobes of Whitted's coefficients, scaled by one common factor if their sum exceeds 1.
Bsdf bsdf_of_coefficients(const Material& m, std::span<const Texture> textures,
                          const SurfaceLookup& lookup, const BsdfPlace& place) {
    const auto color = [&](const ColorInput& input) {
        return not_negative(color_at(input, textures, lookup));
    };
    const Rgb diffuse = not_negative(lookup.color.rgb()) * color(m.diffuse);
    const Rgb mirror = color(m.reflective);
    const Rgb refracted = color(m.transmissive);
    const double exponent = value_at(m.shininess, textures, lookup);
    // Makes the peak of a point light's highlight as bright as in Whitted's equation.
    const double wide = 8.0 / ((exponent > 0.0 ? exponent : 0.0) + 2.0);
    Rgb highlight = wide * color(m.specular);
    for (int i = 0; i < 3; ++i) highlight[i] = std::min(highlight[i], 1.0);
    const double sum = (diffuse + highlight + mirror + refracted).max();
    const double scale = sum > 1.0 ? 1.0 / sum : 1.0;

    Bsdf bsdf;
    const auto add = [&](const Rgb& share, const Lobe& lobe) {
        bsdf.add(place.waves.reflectance(scale * share), lobe);
    };
    add(diffuse, Lambert{});
    if (!highlight.is_black()) add(highlight, BlinnPhong(exponent));
    const double roughness = roughness_of(m, textures, lookup);
    if (!mirror.is_black()) {
        const ConstantTerm all{place.waves.reflectance(scale * mirror)};
        add(mirror, reflection_lobe(roughness, all));
    }
    if (!refracted.is_black()) {
        const double eta = eta_at(place, value_at(m.index, textures, lookup));
        add(refracted, SmoothDielectric{.eta = eta, .fresnel = false, .etas = etas_at(place)});
    }
    return bsdf;
}

Bsdf bsdf_of_conductor(const Material& m, const Conductor& c, std::span<const Texture> textures,
                       const SurfaceLookup& lookup, const BsdfPlace& place) {
    Bsdf bsdf;
    const double roughness = roughness_of(m, textures, lookup);
    ConductorTerm term;
    if (const Metal* const metal = place.waves.is_spectral() ? find_metal(c.name) : nullptr) {
        for (int i = 0; i < Spectrum::kCount; ++i) {
            const MetalAtWave at = constants_at(*metal, place.waves.nm(i));
            term.index[i] = at.index;
            term.extinction[i] = at.extinction;
        }
    } else {
        term = {place.waves.optical_constant(c.index), place.waves.optical_constant(c.extinction)};
    }
    bsdf.add(Spectrum::all(1), reflection_lobe(roughness, term));
    return bsdf;
}

Bsdf bsdf_of_dielectric(const Material& m, std::span<const Texture> textures,
                        const SurfaceLookup& lookup, const BsdfPlace& place) {
    Bsdf bsdf;
    const double roughness = roughness_of(m, textures, lookup);
    const double index = value_at(m.index, textures, lookup);
    bsdf.add(Spectrum::all(1),
             boundary_lobe(roughness, place, index, Spectrum::all(1), Spectrum::all(1)));
    return bsdf;
}

}  // namespace

Bsdf bsdf_of(const Material& material, std::span<const Texture> textures,
             const SurfaceLookup& lookup, const BsdfPlace& place) {
    if (material.metallic_roughness) {
        return bsdf_of_metallic_roughness(material, *material.metallic_roughness, textures, lookup,
                                          place);
    }
    if (material.conductor) {
        return bsdf_of_conductor(material, *material.conductor, textures, lookup, place);
    }
    if (material.dielectric) return bsdf_of_dielectric(material, textures, lookup, place);
    return bsdf_of_coefficients(material, textures, lookup, place);
}

}  // namespace alhazen
