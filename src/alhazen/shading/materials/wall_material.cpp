#include "alhazen/shading/materials/wall_material.h"

#include <cmath>

namespace alhazen {

namespace {

Rgb absorption_inside(const Material& volume) {
    if (volume.dielectric) return volume.dielectric->absorption;
    if (!volume.metallic_roughness) return {};
    // Without textures, which absorption does not depend on.
    Material plain;
    MetallicRoughness& p = plain.metallic_roughness.emplace();
    p.thickness = {volume.metallic_roughness->thickness.value, kNoTexture};
    p.attenuation_color = volume.metallic_roughness->attenuation_color;
    p.attenuation_distance = volume.metallic_roughness->attenuation_distance;
    return evaluate(plain, {}, Vec2{}).absorption;
}

void set_absorption(const Material& volume, MetallicRoughness& p) {
    if (volume.metallic_roughness && !volume.dielectric) {
        p.thickness = volume.metallic_roughness->thickness;
        p.attenuation_color = volume.metallic_roughness->attenuation_color;
        p.attenuation_distance = volume.metallic_roughness->attenuation_distance;
        return;
    }
    p.thickness = {1, kNoTexture};
    const Rgb absorption = absorption_inside(volume);
    p.attenuation_distance = 1.0;
    for (int i = 0; i < 3; ++i) p.attenuation_color[i] = std::exp(-absorption[i]);
}

}  // namespace

Material wall_material(const Material& surface, const Material& volume) {
    if (!is_clear(surface) || !is_clear(volume)) return surface;
    Material wall = surface;
    wall.index = volume.index;
    wall.dispersion = volume.dispersion;
    wall.scattering = volume.scattering;
    if (wall.dielectric) {
        wall.dielectric->absorption = absorption_inside(volume);
    } else if (wall.metallic_roughness) {
        MetallicRoughness& p = *wall.metallic_roughness;
        set_absorption(volume, p);
        p.dispersion = volume.metallic_roughness ? volume.metallic_roughness->dispersion : 0.0;
    }
    return wall;
}

}  // namespace alhazen
