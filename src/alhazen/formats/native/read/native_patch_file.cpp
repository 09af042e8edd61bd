#include "alhazen/formats/native/read/native_patch_file.h"

#include "alhazen/base/file.h"
#include "alhazen/base/unicode_marks.h"
#include "alhazen/formats/bpt/bpt_reader.h"

namespace alhazen {

bool read_native_patch_file(BlockReader& reader, NativeContext& context, const NativeScope& scope,
                            const FileLocation& where, AnyShape& shape) {
    auto* mesh = std::get_if<PatchMesh>(&shape);
    if (mesh == nullptr) return true;
    std::string file;
    const bool named = reader.read("file", file);
    if (!reader.has("file")) return true;
    if (!named) return false;
    const TextNode place = *reader.find("file");
    for (const char* field : {"degree_u", "degree_v", "points", "weights", "patches"}) {
        if (reader.has(field)) {
            reader.error(place,
                         "a patch_mesh has a file or '" + std::string(field) + "', not both");
            return false;
        }
    }
    try {
        const auto path = resolve_inside(context.roots, scope.folder, file);
        context.diagnostics.note_file(path);
        const std::string bytes = read_file(path);
        std::vector<BptMesh> meshes = read_bpt(without_byte_order_mark(bytes), path.string(),
                                               context.options, context.diagnostics);
        if (meshes.size() > 1) {
            reader.error(place, file + " has patches of " + std::to_string(meshes.size()) +
                                    " pairs of degrees, a patch_mesh has one; 'alhazen convert' "
                                    "makes a scene of them");
        } else if (!meshes.empty()) {
            *mesh = std::move(meshes[0].mesh);
        }
    } catch (const Error& error) {
        if (error.kind() == ErrorKind::Resource) throw;
        reader.error(place, error.what());
    }
    context.count_elements(mesh->points.size(), where);
    return !mesh->patches.empty();
}

}  // namespace alhazen
