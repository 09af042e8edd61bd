#include "alhazen/formats/brlcad/brlcad_importer.h"

#include "alhazen/base/file.h"
#include "alhazen/base/unicode_marks.h"
#include "alhazen/formats/brlcad/brlcad_builder.h"
#include "alhazen/formats/brlcad/brlcad_lights.h"
#include "alhazen/formats/brlcad/brlcad_v4_reader.h"
#include "alhazen/formats/brlcad/brlcad_v5_reader.h"
#include "alhazen/formats/brlcad/brlcad_view.h"
#include "alhazen/formats/mesh/mesh_scene.h"

namespace alhazen {

namespace {

/// What `rt` shows of a region that an eye ray starts in: 18 % grey, less by 0.8 for each of the
/// six times that the ray is started anew behind the way through the region and is in it again.
/// Source: `moss`, all 2968 pixels whose rays start inside its platform are 12 of 255.
constexpr double kInsideGrey = 0.18 * 0.8 * 0.8 * 0.8 * 0.8 * 0.8 * 0.8;

/// The conventions of BRL-CAD's pictures.
Conventions brlcad_conventions() {
    Conventions c;
    c.shading.highlight = ShadingConventions::Highlight::Schlick;
    c.shading.ambient_from_eye = true;
    c.shading.inside_color = Rgb{kInsideGrey, kInsideGrey, kInsideGrey};
    c.shading.air_index = 1.0;
    c.sampling.pixel_sample = SamplingConventions::PixelSample::LowerLeftCorner;
    c.film.round_output = true;
    return c;
}

/// The background of `rt`: blue 1 of 255 distinguishes it from black surfaces.
constexpr Rgb kBackground{0, 0, 1.0 / 255.0};

/// Size limit of view scripts.
constexpr std::uint64_t kMaxScriptBytes = std::uint64_t{16} << 20;

void add_cameras(const ImportSource& source, SceneDescription& scene, const Box3& box,
                 Diagnostics& diagnostics) {
    const std::filesystem::path& script = source.options.view_script;
    if (!script.empty()) {
        diagnostics.note_file(script);
        const std::string bytes = read_file(script, kMaxScriptBytes);
        refuse_wide_text(bytes, script.string());
        const std::string text(without_byte_order_mark(bytes));
        scene.cameras = read_brlcad_views(text, script.string(), box, diagnostics);
        if (const auto background = brlcad_view_background(text)) {
            scene.picture.background = background;
        }
    }
    for (CameraDescription& camera : brlcad_cameras(box, {source.path.string(), 0, 0})) {
        scene.cameras.push_back(std::move(camera));
    }
}

}  // namespace

const char* BrlcadImporter::description() const {
    return "BRL-CAD text databases (g2asc), versions 4 and 5, as exact solids";
}

int BrlcadImporter::recognise(const ImportSource& source) const {
    if (BrlcadV4Reader::recognise(source.bytes) || BrlcadV5Reader::recognise(source.bytes)) {
        return 2;
    }
    return has_suffix(source.path, ".asc") || has_suffix(source.path, ".g") ? 1 : 0;
}

SceneDescription BrlcadImporter::import(const ImportSource& source,
                                        Diagnostics& diagnostics) const {
    SceneDescription scene;
    scene.format = name();
    scene.path = source.path;
    scene.conventions = brlcad_conventions();
    scene.up_axis = UpAxis::Z;
    scene.picture = {.width = 512, .height = 512, .background = kBackground};
    BrlcadDatabase database;
    database.file = source.path.string();
    if (BrlcadV4Reader::recognise(source.bytes)) {
        BrlcadV4Reader(source, database, diagnostics).read();
    } else if (report_wide_text(source.bytes, database.file, diagnostics)) {
        return scene;
    } else if (source.bytes.find('\0') != std::string_view::npos) {
        diagnostics.error({database.file, 0, 0},
                          "not a text database; convert a binary one with BRL-CAD's g2asc");
    } else {
        BrlcadV5Reader(source, database, diagnostics).read();
    }
    BrlcadMaterials materials(database, scene, diagnostics);
    BrlcadBuilder(database, source, scene, materials, diagnostics).build(source.options.objects);
    if (diagnostics.error_count() != 0) return scene;
    BrlcadBounds bounds(scene);
    const Box3 box = bounds.of(scene.root);
    add_cameras(source, scene, box, diagnostics);
    add_brlcad_lights(scene, materials, bounds, diagnostics);
    return scene;
}

}  // namespace alhazen
