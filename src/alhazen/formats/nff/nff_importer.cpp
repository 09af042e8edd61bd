#include "alhazen/formats/nff/nff_importer.h"

#include <algorithm>
#include <array>

#include "alhazen/base/unicode_marks.h"
#include "alhazen/formats/nff/nff_reader.h"

namespace alhazen {

namespace {

/// The conventions of the pictures of Haines' databases.
Conventions nff_conventions() {
    Conventions c;
    c.shading.highlight = ShadingConventions::Highlight::Phong;
    // Any surface, also glass, blocks a shadow ray.
    c.shading.shadow_tint = ShadingConventions::ShadowTint::Opaque;
    c.shading.refraction_tint = ShadingConventions::RefractionTint::PerEvent;
    // `ambient` of the materials is their diffuse colour, except where 'fm' gives it.
    c.shading.ambient_factor = ShadingConventions::AmbientFactor::Ambient;
    c.shading.ambient_inside_times_kt = false;
    c.shading.transmitting_surfaces_reflect = true;
    c.shading.air_index = 1.0;
    // The eye ray counts as the first of five generations.
    c.importing.headlight = false;
    c.shading.max_depth = 4;
    return c;
}

/// True if the start of the text has lines that begin with each of the words.
bool has_lines(std::string_view text, std::span<const std::string_view> words) {
    return std::all_of(words.begin(), words.end(), [&](std::string_view word) {
        for (std::size_t at = text.find(word); at != std::string_view::npos;
             at = text.find(word, at + 1)) {
            const std::size_t end = at + word.size();
            const bool begins_line = at == 0 || TextCursor::is_newline(text[at - 1]);
            if (begins_line && end < text.size() && TextCursor::is_space(text[end])) return true;
        }
        return false;
    });
}

}  // namespace

const char* NffImporter::description() const {
    return "Neutral File Format of the Standard Procedural Databases (and parts of AFF)";
}

int NffImporter::recognise(const ImportSource& source) const {
    static constexpr std::array<std::string_view, 5> kView{"v", "from", "at", "up", "angle"};
    if (has_lines(source.bytes.substr(0, 65536), kView)) return 2;
    const std::string suffix = source.path.extension().string();
    return suffix == ".nff" || suffix == ".aff" ? 1 : 0;
}

SceneDescription NffImporter::import(const ImportSource& source, Diagnostics& diagnostics) const {
    SceneDescription scene;
    scene.format = name();
    scene.path = source.path;
    scene.conventions = nff_conventions();
    if (report_wide_text(source.bytes, source.path.string(), diagnostics)) return scene;
    NffReader(source, scene, diagnostics).read();
    return scene;
}

}  // namespace alhazen
