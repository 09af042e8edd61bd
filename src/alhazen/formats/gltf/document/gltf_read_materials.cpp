// Readers of materials and their extensions.
#include <cmath>

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
    object.with_extension("KHR_materials_volume_scatter", [&](const JsonObject& extension) {
        extension.numbers_into("multiscatterColor", material.multiscatter, kUnitRange);
        extension.number_into("scatterAnisotropy", material.scatter_anisotropy, {});
        if (!(std::abs(material.scatter_anisotropy) < 1)) {
            extension.error("scatterAnisotropy", "expected a number above -1 and below 1");
        }
        if (!material.attenuation_distance) {
            extension.warning(
                "multiscatterColor",
                "has no effect without an attenuationDistance of KHR_materials_volume");
        }
    });
    object.with_extension("KHR_materials_specular", [&](const JsonObject& extension) {
        extension.number_into("specularFactor", material.specular, kUnitRange);
        extension.numbers_into("specularColorFactor", material.specular_color, kNotNegative);
        material.specular_texture = read_texture_info(extension, "specularTexture");
        material.specular_color_texture = read_texture_info(extension, "specularColorTexture");
    });
}

void read_layers(const JsonObject& object, Material& material) {
    object.with_extension("KHR_materials_clearcoat", [&](const JsonObject& extension) {
        extension.number_into("clearcoatFactor", material.coat, kUnitRange);
        extension.number_into("clearcoatRoughnessFactor", material.coat_roughness, kUnitRange);
        material.coat_texture = read_texture_info(extension, "clearcoatTexture");
        material.coat_roughness_texture = read_texture_info(extension, "clearcoatRoughnessTexture");
        material.coat_normal_texture =
            read_texture_info(extension, "clearcoatNormalTexture", "scale");
    });
    object.with_extension("KHR_materials_sheen", [&](const JsonObject& extension) {
        extension.numbers_into("sheenColorFactor", material.sheen_color, kUnitRange);
        extension.number_into("sheenRoughnessFactor", material.sheen_roughness, kUnitRange);
        material.sheen_color_texture = read_texture_info(extension, "sheenColorTexture");
        material.sheen_roughness_texture = read_texture_info(extension, "sheenRoughnessTexture");
    });
    object.with_extension("KHR_materials_iridescence", [&](const JsonObject& extension) {
        extension.number_into("iridescenceFactor", material.iridescence, kUnitRange);
        extension.number_into("iridescenceIor", material.film_ior, {.lo = 1});
        extension.number_into("iridescenceThicknessMinimum", material.film_thinnest, kNotNegative);
        extension.number_into("iridescenceThicknessMaximum", material.film_thickest, kNotNegative);
        material.iridescence_texture = read_texture_info(extension, "iridescenceTexture");
        material.film_thickness_texture =
            read_texture_info(extension, "iridescenceThicknessTexture");
    });
    object.with_extension("KHR_materials_anisotropy", [&](const JsonObject& extension) {
        extension.number_into("anisotropyStrength", material.anisotropy, kUnitRange);
        extension.number_into("anisotropyRotation", material.anisotropy_rotation, {});
        material.anisotropy_texture = read_texture_info(extension, "anisotropyTexture");
    });
    object.with_extension("KHR_materials_diffuse_transmission", [&](const JsonObject& extension) {
        extension.number_into("diffuseTransmissionFactor", material.diffuse_transmission,
                              kUnitRange);
        extension.numbers_into("diffuseTransmissionColorFactor",
                               material.diffuse_transmission_color, kUnitRange);
        material.diffuse_transmission_texture =
            read_texture_info(extension, "diffuseTransmissionTexture");
        material.diffuse_transmission_color_texture =
            read_texture_info(extension, "diffuseTransmissionColorTexture");
    });
    object.with_extension("KHR_materials_dispersion", [&](const JsonObject& extension) {
        extension.number_into("dispersion", material.dispersion, kNotNegative);
    });
}

void read_specular_glossiness(const JsonObject& object, Material& material) {
    object.with_extension("KHR_materials_pbrSpecularGlossiness", [&](const JsonObject& extension) {
        SpecularGlossiness& own = material.specular_glossiness.emplace();
        extension.numbers_into("diffuseFactor", own.diffuse, kUnitRange);
        extension.numbers_into("specularFactor", own.specular, kUnitRange);
        extension.number_into("glossinessFactor", own.glossiness, kUnitRange);
        own.diffuse_texture = read_texture_info(extension, "diffuseTexture");
        own.specular_glossiness_texture = read_texture_info(extension, "specularGlossinessTexture");
        if (material.thickness > 0) {
            extension.warning("", "the volume of KHR_materials_volume has no effect beside it");
        }
    });
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
    read_layers(object, material);
    read_specular_glossiness(object, material);
    return material;
}

}  // namespace

void read_materials(const JsonObject& root, Loading& loading) {
    root.each_object("materials", [&](const JsonObject& object, std::size_t) {
        loading.document.materials.push_back(read_material(object));
    });
    // Variants are not rendered, but their description in a file must be consistent.
    root.with_extension("KHR_materials_variants", [](const JsonObject& extension) {
        extension.require("variants");
        extension.each_object("variants", [](const JsonObject& variant, std::size_t) {
            variant.require("name");
            (void)variant.text("name");
        });
    });
}

}  // namespace alhazen::gltf
