#include "alhazen/formats/uw_yaml/uw_yaml_importer.h"

#include "alhazen/formats/uw_yaml/uw_yaml_scene.h"

namespace alhazen {

namespace {

/// The conventions of the reference renderer.
Conventions uw_conventions() {
    Conventions c;
    c.shading.highlight = ShadingConventions::Highlight::BlinnPhong;
    c.shading.shadow_tint = ShadingConventions::ShadowTint::PerCrossing;
    c.shading.refraction_tint = ShadingConventions::RefractionTint::PerEvent;
    c.shading.ambient_factor = ShadingConventions::AmbientFactor::Diffuse;
    c.shading.ambient_inside_times_kt = false;
    c.shading.correct_interpolated_normals = false;
    c.shading.clamp_attenuation = true;
    c.importing.truncate_material_colors = true;
    c.shading.transmitting_surfaces_reflect = false;
    c.shading.air_index = 1.0003;
    c.shading.min_distance = 1e-3;
    c.sampling.pixel_sample = SamplingConventions::PixelSample::Center;
    c.importing.headlight = false;
    c.film.linear_output = true;
    return c;
}

/// True if the text has a line that starts with `key`.
bool has_key(std::string_view text, std::string_view key) {
    for (std::size_t at = text.find(key); at != std::string_view::npos;
         at = text.find(key, at + 1)) {
        if (at == 0 || text[at - 1] == '\n') return true;
    }
    return false;
}

}  // namespace

const char* UwYamlImporter::description() const {
    return "YAML scenes of the UW CSE 457 Trace project (2020)";
}

int UwYamlImporter::recognise(const ImportSource& source) const {
    const std::string_view text = source.bytes.substr(0, kMaxYamlBytes);
    if (has_key(text, "Root:") && has_key(text, "Materials:")) return 2;
    const std::string suffix = source.path.extension().string();
    return suffix == ".yaml" || suffix == ".yml" ? 1 : 0;
}

SceneDescription UwYamlImporter::import(const ImportSource& source,
                                        Diagnostics& diagnostics) const {
    SceneDescription scene;
    scene.format = name();
    scene.path = source.path;
    scene.conventions = uw_conventions();
    const std::optional<YAML::Node> document =
        parse_yaml(source.bytes, source.path.string(), source.options.max_nesting, diagnostics);
    if (document) UwSceneReader(*document, source, scene, diagnostics).read();
    return scene;
}

}  // namespace alhazen
