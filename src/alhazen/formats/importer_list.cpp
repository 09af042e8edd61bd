#include "alhazen/formats/importer_list.h"

#include <algorithm>
#include <array>

#include "alhazen/base/file.h"
#include "alhazen/base/unicode_marks.h"
#include "alhazen/formats/bpt/bpt_importer.h"
#include "alhazen/formats/brlcad/brlcad_importer.h"
#include "alhazen/formats/gltf/scene/gltf_importer.h"
#include "alhazen/formats/native/read/native_importer.h"
#include "alhazen/formats/nff/nff_importer.h"
#include "alhazen/formats/obj/obj_importer.h"
#include "alhazen/formats/ply/ply_importer.h"
#include "alhazen/formats/ray/ray_importer.h"
#include "alhazen/formats/rib/rib_importer.h"
#include "alhazen/formats/stl/stl_importer.h"
#include "alhazen/formats/uw_yaml/uw_yaml_importer.h"

namespace alhazen {

std::span<const Importer* const> importers() {
    static const NativeImporter native;
    static const RayImporter ray;
    static const UwYamlImporter uw_yaml;
    static const NffImporter nff;
    static const GltfImporter gltf;
    static const ObjImporter obj;
    static const PlyImporter ply;
    static const StlImporter stl;
    static const BrlcadImporter brlcad;
    static const BptImporter bpt;
    static const RibImporter rib;
    static const std::array<const Importer*, 11> table{&native, &ray, &uw_yaml, &nff, &gltf, &obj,
                                                       &ply,    &stl, &brlcad,  &bpt, &rib};
    return table;
}

const Importer& find_importer(const ImportSource& source) {
    const Importer* best = nullptr;
    int best_score = 0;
    for (const Importer* importer : importers()) {
        const int score = importer->recognise(source);
        if (score > best_score) {
            best = importer;
            best_score = score;
        }
    }
    if (best != nullptr) return *best;
    refuse_wide_text(source.bytes, source.path.string());
    std::string known;
    for (const Importer* importer : importers()) {
        known += known.empty() ? "" : ", ";
        known += importer->name();
    }
    throw Error(ErrorKind::Scene, "not a scene of a known format; expected one of " + known,
                {source.path.string(), 0, 0});
}

namespace {

/// Makes the objects of these names the only parts of the root. Throws Error (Usage) for an unknown
/// name.
void choose_objects(SceneDescription& description, std::span<const std::string> names) {
    ObjectDescription root;
    root.name = "chosen";
    for (const std::string& name : names) {
        const auto& objects = description.objects;
        const auto found = std::find_if(objects.begin(), objects.end(),
                                        [&](const auto& object) { return object.name == name; });
        if (found == objects.end()) {
            throw Error(ErrorKind::Usage, "the scene has no object '" + name + "'");
        }
        Part part;
        part.what = static_cast<ObjectIndex>(found - objects.begin());
        part.name = name;
        part.location = found->location;
        root.parts.push_back(std::move(part));
    }
    description.objects.push_back(std::move(root));
    description.root = static_cast<ObjectIndex>(description.objects.size() - 1);
}

}  // namespace

SceneDescription import_scene(const std::filesystem::path& path, const ImportOptions& options,
                              Diagnostics& diagnostics) {
    const std::string file = read_file(path);
    // All text formats are ASCII or UTF-8.
    const std::string_view bytes = without_byte_order_mark(file);
    if (is_empty_file(bytes)) {
        throw Error(ErrorKind::Scene, "the file is empty", {path.string(), 0, 0});
    }
    const ImportSource source{bytes, path, options};
    const Importer& importer = find_importer(source);
    if (!options.view_script.empty() && !importer.reads_view_scripts()) {
        throw Error(ErrorKind::Usage,
                    "view scripts are not supported by the format " + std::string(importer.name()));
    }
    if (options.time && !importer.applies_animations()) {
        diagnostics.warning({path.string(), 0, 0}, "a time is given, but files of the format " +
                                                       std::string(importer.name()) +
                                                       " have no animations");
    }
    SceneDescription description = importer.import(source, diagnostics);
    if (!options.objects.empty() && !importer.chooses_objects()) {
        choose_objects(description, options.objects);
    }
    description.files = diagnostics.files();
    // Validates incomplete imports too, to report all errors at once, but without findings about
    // the whole scene (no visible geometry), which may be consequences of errors.
    const bool complete = diagnostics.error_count() == 0;
    Diagnostics findings;
    validate(description, findings);
    for (const Diagnostic& finding : findings.all()) {
        if (finding.severity == Severity::Warning) {
            if (complete) diagnostics.warning(finding.location, finding.message);
        } else if (complete || finding.location.line > 0) {
            diagnostics.error(finding.location, finding.message);
        }
    }
    diagnostics.throw_if_errors();
    return description;
}

}  // namespace alhazen
