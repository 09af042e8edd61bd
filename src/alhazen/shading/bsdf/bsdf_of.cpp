/// Materials as lobes; docs/reference/materials.md states what becomes of what.

#include <algorithm>
#include <cmath>

#include "alhazen/shading/bsdf/bsdf.h"
#include "alhazen/shading/materials/texture_inputs.h"

namespace alhazen {

namespace {

/// Whitted's coefficients. What they give out together beyond the light that comes in is scaled
/// down, by one factor for all.
Bsdf bsdf_of_coefficients(const Material& m, std::span<const Texture> textures,
                          const SurfaceLookup& lookup, const BsdfPlace& place) {
    const auto color = [&](const ColorInput& input) {
        const Rgb c = color_at(input, textures, lookup);
        return Rgb{std::max(c.r, 0.0), std::max(c.g, 0.0), std::max(c.b, 0.0)};
    };
    const Rgb diffuse = lookup.color.rgb() * color(m.diffuse);
    const Rgb mirror = color(m.reflective);
    const Rgb refracted = color(m.transmissive);
    const double sum = (diffuse + mirror + refracted).max();
    const double scale = sum > 1.0 ? 1.0 / sum : 1.0;

    Bsdf bsdf;
    bsdf.add(scale * diffuse, Lambert{});
    bsdf.add(scale * mirror, Mirror{});
    if (!refracted.is_black()) {
        const double index = std::max(value_at(m.index, textures, lookup), 1e-3);
        const double own = place.from_inside ? index : 1.0 / index;
        const double eta = place.eta > 0.0 ? place.eta : own;
        bsdf.add(scale * refracted, SmoothDielectric{.eta = eta, .fresnel = false});
    }
    return bsdf;
}

Bsdf bsdf_of_metallic_roughness(const Material& m, const MetallicRoughness& p,
                                std::span<const Texture> textures, const SurfaceLookup& lookup,
                                const BsdfPlace& place) {
    Bsdf bsdf;
    if (p.unlit) return bsdf;
    const auto unit = [](double x) { return x > 0.0 ? std::min(x, 1.0) : 0.0; };
    const Rgb base = lookup.color.rgb() * color_at(p.base_color, textures, lookup);
    const double metallic = unit(value_at(p.metallic, textures, lookup));
    const double transmission = unit(value_at(p.transmission, textures, lookup));
    bsdf.add((1.0 - metallic) * (1.0 - transmission) * base, Lambert{});
    bsdf.add(metallic * base, Mirror{});
    const double index = m.index.value >= 1.0 ? m.index.value : 1.0;
    if (p.thickness.value > 0.0) {
        const double own = place.from_inside ? index : 1.0 / index;
        const double eta = place.eta > 0.0 ? place.eta : own;
        bsdf.add(Rgb{1, 1, 1} * ((1.0 - metallic) * transmission),
                 SmoothDielectric{.eta = eta, .transmission_tint = base});
    } else {
        bsdf.add((1.0 - metallic) * transmission * base, ThinSheet{});
    }
    return bsdf;
}

}  // namespace

Bsdf bsdf_of(const Material& material, std::span<const Texture> textures,
             const SurfaceLookup& lookup, const BsdfPlace& place) {
    if (material.metallic_roughness) {
        return bsdf_of_metallic_roughness(material, *material.metallic_roughness, textures, lookup,
                                          place);
    }
    return bsdf_of_coefficients(material, textures, lookup, place);
}

}  // namespace alhazen
