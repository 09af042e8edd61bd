// Readers of materials and their extensions.
#include "alhazen/formats/gltf/document/gltf_texture_info.h"

namespace alhazen::gltf {

namespace {

void read_metallic_roughness(const JsonObject& object, Material& material) {
    object.with_object("pbrMetallicRoughness", [&](const JsonObject& pbr) {
        pbr.numbers_into("baseColorFactor", material.base_color, kUnitRange);
        pbr.number_into("metallicFactor", material.metallic, kUnitRange);
        pbr.number_into("roughnessFactor", material.roughness, kUnitRange);
        material.base_color_texture = read_texture_info(pbr, "baseColorTexture");
        material.metallic_roughness_texture = read_texture_info(pbr, "metallicRoughnessTexture");
    });
}

void read_alpha(const JsonObject& object, Material& material) {
    const std::string mode = object.text("alphaMode").value_or("OPAQUE");
    if (mode == "MASK") {
        material.alpha_mode = AlphaMode::Mask;
    } else if (mode == "BLEND") {
        material.alpha_mode = AlphaMode::Blend;
    } else if (mode != "OPAQUE") {
        object.warning("alphaMode", "expected OPAQUE, MASK or BLEND; taken as OPAQUE");
    }
    object.number_into("alphaCutoff", material.alpha_cutoff, kNotNegative);
    if (object.has("alphaCutoff") && mode != "MASK") {
        object.warning("alphaCutoff", "has no effect unless alphaMode is MASK");
    }
}

void read_dielectric_extensions(const JsonObject& object, Material& material) {
    object.with_extension("KHR_materials_ior", [&](const JsonObject& extension) {
        extension.number_into("ior", material.ior, kNotNegative);
        // 0 has a special meaning: total reflection.
        if (material.ior != 0 && material.ior < 1) {
            extension.error("ior", "expected 0 or a number from 1");
        }
    });
    object.with_extension("KHR_materials_transmission", [&](const JsonObject& extension) {
        extension.number_into("transmissionFactor", material.transmission, kUnitRange);
        material.transmission_texture = read_texture_info(extension, "transmissionTexture");
    });
    object.with_extension("KHR_materials_volume", [&](const JsonObject& extension) {
        extension.number_into("thicknessFactor", material.thickness, kNotNegative);
        material.thickness_texture = read_texture_info(extension, "thicknessTexture");
        material.attenuation_distance = extension.number("attenuationDistance", kPositive);
        extension.numbers_into("attenuationColor", material.attenuation_color, kUnitRange);
    });
    object.with_extension("KHR_materials_specular", [&](const JsonObject& extension) {
        extension.number_into("specularFactor", material.specular, kUnitRange);
        extension.numbers_into("specularColorFactor", material.specular_color, kNotNegative);
        material.specular_texture = read_texture_info(extension, "specularTexture");
        material.specular_color_texture = read_texture_info(extension, "specularColorTexture");
    });
}

/// Checks the ranges of numbers in ignored extensions; the file is invalid outside them.
void check_ignored_extensions(const JsonObject& object) {
    struct Limited {
        const char* extension;
        const char* member;
        Range range;
    };
    constexpr Limited kLimited[] = {
        {"KHR_materials_anisotropy", "anisotropyStrength", kUnitRange},
        {"KHR_materials_clearcoat", "clearcoatFactor", kUnitRange},
        {"KHR_materials_clearcoat", "clearcoatRoughnessFactor", kUnitRange},
        {"KHR_materials_dispersion", "dispersion", kNotNegative},
        {"KHR_materials_iridescence", "iridescenceFactor", kUnitRange},
        {"KHR_materials_sheen", "sheenRoughnessFactor", kUnitRange},
    };
    for (const Limited& limited : kLimited) {
        object.with_extension(limited.extension, [&](const JsonObject& extension) {
            (void)extension.number(limited.member, limited.range);
        });
    }
}

Material read_material(const JsonObject& object) {
    Material material;
    material.name = object.text("name").value_or("");
    read_metallic_roughness(object, material);
    material.normal_texture = read_texture_info(object, "normalTexture", "scale");
    material.occlusion_texture = read_texture_info(object, "occlusionTexture", "strength");
    material.emissive_texture = read_texture_info(object, "emissiveTexture");
    object.numbers_into("emissiveFactor", material.emissive, kUnitRange);
    read_alpha(object, material);
    material.double_sided = object.flag("doubleSided");
    object.with_extension("KHR_materials_unlit", [&](const JsonObject&) { material.unlit = true; });
    object.with_extension("KHR_materials_emissive_strength", [&](const JsonObject& extension) {
        extension.number_into("emissiveStrength", material.emissive_strength, kNotNegative);
    });
    read_dielectric_extensions(object, material);
    check_ignored_extensions(object);
    return material;
}

}  // namespace

void read_materials(const JsonObject& root, Loading& loading) {
    root.each_object("materials", [&](const JsonObject& object, std::size_t) {
        loading.document.materials.push_back(read_material(object));
    });
}

}  // namespace alhazen::gltf
