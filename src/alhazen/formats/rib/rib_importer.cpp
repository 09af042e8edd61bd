#include "alhazen/formats/rib/rib_importer.h"

#include <algorithm>

#include "alhazen/formats/mesh/mesh_scene.h"
#include "alhazen/formats/rib/rib_interpreter.h"
#include "alhazen/formats/text/text_cursor.h"

namespace alhazen {

namespace {

/// True if the text begins with a request that occurs at the beginning of RIB files and in no other
/// format.
bool looks_like_rib(std::string_view bytes) {
    static constexpr std::array<std::string_view, 17> kFirst{
        "version", "Format",         "Display",     "Projection",     "WorldBegin", "FrameBegin",
        "Option",  "PixelSamples",   "Exposure",    "AttributeBegin", "Patch",      "PatchMesh",
        "NuPatch", "TransformBegin", "ObjectBegin", "ShadingRate",    "Declare"};
    if (bytes.starts_with("##RenderMan")) return true;
    TextCursor cursor(bytes.substr(0, 65536));
    if (!cursor.skip_to_word("#")) return false;
    const std::string_view word = cursor.word();
    if (std::find(kFirst.begin(), kFirst.end(), word) == kFirst.end()) return false;
    // The arguments of a request begin like those of RIB: a number, a string, an array or none.
    if (!cursor.skip_blanks()) return word.ends_with("Begin") || word.starts_with("Patch");
    const char next = cursor.peek();
    return next == '"' || next == '[' || next == '#' || next == '-' || (next >= '0' && next <= '9');
}

}  // namespace

const char* RibImporter::description() const {
    return "RenderMan scenes of patches (.rib), docs/reference/formats/rib.md";
}

int RibImporter::recognise(const ImportSource& source) const {
    if (looks_like_rib(source.bytes)) return 2;
    return has_suffix(source.path, ".rib") ? 1 : 0;
}

SceneDescription RibImporter::import(const ImportSource& source, Diagnostics& diagnostics) const {
    SceneDescription scene = make_mesh_scene(source, name(), UpAxis::Y);
    if (is_plain_text(source, diagnostics)) interpret_rib(source, scene, diagnostics);
    if (scene.materials.empty()) {
        scene.materials.push_back({default_mesh_material(), {source.path.string(), 0, 0}});
    }
    return scene;
}

}  // namespace alhazen
