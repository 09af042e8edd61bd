#include "alhazen/formats/ray/ray_importer.h"

#include "alhazen/base/unicode_marks.h"
#include "alhazen/formats/ray/ray_objects.h"
#include "alhazen/formats/ray/ray_view.h"

namespace alhazen {

namespace {

constexpr std::string_view kHeader = "SBT-raytracer";
constexpr double kLatestVersion = 1.1;

/// True if the text begins with the header, after comments and blanks.
bool starts_with_header(std::string_view bytes) {
    // Covers a long comment before the header; recognition reads no more of a large file.
    constexpr std::size_t kLook = 65536;
    const SourceText source(bytes.substr(0, kLook), "");
    Diagnostics ignored;
    const Token first = Lexer(source, ignored).next();
    return first.kind == TokenKind::Word && first.text == kHeader;
}

void check_version(TextNode header, Diagnostics& diagnostics) {
    if (header.broken()) return;
    if (header.empty() || !header.first().is(NodeKind::Number)) {
        diagnostics.error(header.location(), "SBT-raytracer: expected a version number");
    } else if (header.first().number() > kLatestVersion) {
        diagnostics.error(header.first().location(),
                          "SBT-raytracer: versions up to 1.1 are supported");
    }
}

/// Reads all items. The first item is the header; a default material applies to all items after it.
void read_items(TextNode root, RayContext& context) {
    RayMaterials materials(context);
    RayObjects objects(context, materials);
    RayMaterial material;
    bool header = true;
    for (const TextNode item : root) {
        if (header) {
            check_version(item, context.diagnostics);
            header = false;
            continue;
        }
        if (item.broken()) continue;
        if (item.is(NodeKind::Entry) && is_ray_camera_or_light(item.text())) {
            read_ray_camera_or_light(item, context);
        } else {
            objects.read(item, material);
        }
    }
    if (context.camera.without_axes) {
        context.diagnostics.error(
            *context.camera.without_axes,
            "camera: look_at must not lie at the position, nor along updir from it");
    }
}

}  // namespace

const char* RayImporter::description() const {
    return "SBT-raytracer 1.0, the scene text of the university Trace projects (.ray)";
}

int RayImporter::recognise(const ImportSource& source) const {
    if (starts_with_header(source.bytes)) return 2;
    return source.path.extension() == ".ray" ? 1 : 0;
}

SceneDescription RayImporter::import(const ImportSource& source, Diagnostics& diagnostics) const {
    SceneDescription scene;
    scene.format = name();
    scene.path = source.path;
    scene.objects.push_back({"scene", {}, {source.path.string(), 1, 1}});
    if (report_wide_text(source.bytes, source.path.string(), diagnostics)) return scene;
    if (!starts_with_header(source.bytes)) {
        diagnostics.error({source.path.string(), 1, 1},
                          "not an SBT-raytracer scene: it must begin with 'SBT-raytracer 1.0' "
                          "(Rayshade and other programs use the suffix .ray for other languages)");
        return scene;
    }
    const SourceText text(source.bytes, source.path.string());
    const TextTree tree(
        text,
        {.max_nesting = source.options.max_nesting,
         .max_nodes = source.options.max_elements,
         .pairs_take_blocks = false},  // `material = red { ... }`: the material, then a group
        diagnostics);
    RayContext context{scene, diagnostics, source.options, detect_ray_family(tree.root())};
    scene.conventions = context.family.conventions;
    read_items(tree.root(), context);
    if (scene.cameras.empty()) {
        // Default camera of the programs: at the origin, looking along -z, image height 1 at
        // distance 1.
        scene.cameras.push_back(
            {"default", PerspectiveCamera{}, 1.0, {source.path.string(), 1, 1}});
    }
    return scene;
}

}  // namespace alhazen
