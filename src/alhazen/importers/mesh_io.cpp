#include "alhazen/importers/mesh_io.h"

#include <algorithm>
#include <array>
#include <cctype>

#include "alhazen/base/file.h"
#include "alhazen/importers/obj_reader.h"
#include "alhazen/importers/ply_reader.h"
#include "alhazen/importers/text_cursor.h"

namespace alhazen {

namespace {

bool looks_like_ply(std::string_view bytes) {
    return bytes.starts_with("ply") && bytes.size() > 3 && TextCursor::is_space(bytes[3]);
}

/// The first statement of the text is one of OBJ.
bool looks_like_obj(std::string_view bytes) {
    static constexpr std::array<std::string_view, 10> kFirst{"v", "vn", "vt",     "f",      "g",
                                                             "o", "s",  "usemtl", "mtllib", "vp"};
    TextCursor cursor(bytes.substr(0, 65536));
    if (!cursor.skip_to_word("#")) return false;
    return std::find(kFirst.begin(), kFirst.end(), cursor.word()) != kFirst.end();
}

bool has_suffix(const std::filesystem::path& path, std::string_view suffix) {
    std::string own = path.extension().string();
    std::transform(own.begin(), own.end(), own.begin(),
                   [](unsigned char c) { return char(std::tolower(c)); });
    return own == suffix;
}

}  // namespace

TriangleMesh read_mesh(const std::filesystem::path& path, const ImportOptions& options,
                       Diagnostics& diagnostics) {
    const std::string file = path.string();
    const std::string bytes = read_file(path, options.max_included_bytes);
    std::string_view text = bytes;
    if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
    if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF")) {
        diagnostics.error({file, 1, 1}, "the file is UTF-16 text; expected ASCII or UTF-8");
        return {};
    }
    if (looks_like_ply(text) || has_suffix(path, ".ply")) {
        return read_ply(text, file, options, diagnostics);
    }
    if (looks_like_obj(text) || has_suffix(path, ".obj")) {
        return read_obj(text, file, options, diagnostics);
    }
    diagnostics.error({file, 1, 1}, "not a mesh of a known format; expected PLY or OBJ");
    return {};
}

}  // namespace alhazen
