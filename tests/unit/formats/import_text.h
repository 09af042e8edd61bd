#pragma once
/// Imports a scene or mesh from the text of a test.

#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "alhazen/formats/importer_list.h"
#include "alhazen/formats/mesh_files/mesh_io.h"
#include "alhazen/formats/obj/obj_reader.h"
#include "alhazen/formats/ply/ply_reader.h"

namespace alhazen::testing {

/// Runs the importer that recognizes `bytes` under the name `path`, without validation.
inline SceneDescription import_text(std::string_view bytes, const std::filesystem::path& path,
                                    Diagnostics& diagnostics) {
    const ImportOptions options;
    const ImportSource source{bytes, path, options};
    return find_importer(source).import(source, diagnostics);
}

/// All findings, one per line.
inline std::string text_of(const Diagnostics& diagnostics) {
    std::string text;
    for (const Diagnostic& diagnostic : diagnostics.all()) text += to_string(diagnostic) + '\n';
    return text;
}

/// Returns whether a finding contains `part`.
inline bool mentions(const Diagnostics& diagnostics, std::string_view part) {
    return text_of(diagnostics).find(part) != std::string::npos;
}

/// A temporary folder, removed by the destructor.
class TemporaryFolder {
  public:
    TemporaryFolder() {
        std::string name = (std::filesystem::temp_directory_path() / "alhazen_XXXXXX").string();
        path_ = mkdtemp(name.data());
    }
    ~TemporaryFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    std::filesystem::path write(const std::string& name, std::string_view bytes) const {
        const std::filesystem::path file = path_ / name;
        std::filesystem::create_directories(file.parent_path());
        std::ofstream(file, std::ios::binary).write(bytes.data(), std::streamsize(bytes.size()));
        return file;
    }
    [[nodiscard]] const std::filesystem::path& path() const { return path_; }

  private:
    std::filesystem::path path_;
};

/// Reads a mesh from bytes; `name` ends in .ply or .obj.
inline TriangleMesh mesh_of(std::string_view bytes, const std::string& name,
                            Diagnostics& diagnostics, const ImportOptions& options = {}) {
    return name.ends_with(".ply") ? read_ply(bytes, name, options, diagnostics)
                                  : read_obj(bytes, name, options, diagnostics);
}

}  // namespace alhazen::testing
