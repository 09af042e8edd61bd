#pragma once
/// Importer interface: bytes in, scene description and diagnostics out. Adding a format:
/// CONTRIBUTING.md.

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "alhazen/base/diagnostics.h"
#include "alhazen/imaging/codecs/image_io.h"
#include "alhazen/scene_model/scene_description.h"

namespace alhazen {

struct ImportOptions {
    /// File names in a scene are resolved relative to the scene file. The files must lie in the
    /// scene's folder (or the one that the format prescribes) or in one of these folders, after
    /// following symbolic links.
    std::vector<std::filesystem::path> allowed_folders;
    int max_nesting = 256;  ///< nesting depth of blocks and groups in text formats
    int max_include_depth = 16;
    std::uint64_t max_included_bytes = std::uint64_t{1} << 32;
    /// Limit on vertices, triangles or primitives per file. glTF counts accessor elements once per
    /// use (a mesh read for two sets of morph weights counts twice). JSON values: the larger
    /// of a twentieth of this limit and one million.
    std::uint64_t max_elements = 400'000'000;
    /// Memory limit of the meshes and parts that a glTF file generates, including shared data
    /// expanded by morph weights, skins and instances. None: 64 MiB plus 64 times the bytes of the
    /// file and its buffers, at most 16 GiB.
    std::optional<std::uint64_t> max_made_bytes;
    ImageLimits image_limits;  ///< per texture
    /// Time at which animations are sampled, in seconds; none: rest pose.
    std::optional<double> time;
    std::string animation;              ///< name or index of the animation to apply; empty: all
    std::vector<std::string> objects;   ///< names of the objects to import; empty: all
    std::filesystem::path view_script;  ///< file of views that accompanies the scene; empty: none
};

/// Input of an importer: the bytes of the file and their origin.
struct ImportSource {
    std::string_view bytes;
    std::filesystem::path path;  ///< for error locations and for resolving file names
    const ImportOptions& options;
};

/// True for a file of nothing but white space.
[[nodiscard]] inline bool is_empty_file(std::string_view bytes) {
    return bytes.find_first_not_of(" \t\r\n") == std::string_view::npos;
}

class Importer {
  public:
    virtual ~Importer() = default;
    [[nodiscard]] virtual const char* name() const = 0;         ///< as in `alhazen list formats`
    [[nodiscard]] virtual const char* description() const = 0;  ///< one line
    /// Confidence that the bytes are of this format: 0 none, 1 by suffix only, 2 by content.
    [[nodiscard]] virtual int recognise(const ImportSource& source) const = 0;
    /// True if the importer creates only the objects of `ImportOptions::objects`; if false, they
    /// are selected after the import.
    [[nodiscard]] virtual bool chooses_objects() const { return false; }
    /// True if the format supports `ImportOptions::view_script`.
    [[nodiscard]] virtual bool reads_view_scripts() const { return false; }
    /// True if files may have animations, of which `ImportOptions::time` is a moment.
    [[nodiscard]] virtual bool applies_animations() const { return false; }
    /// Imports all readable content. Findings go to `diagnostics`; the result is valid only without
    /// errors. Throws Error only for limits (Resource) and unreadable files.
    [[nodiscard]] virtual SceneDescription import(const ImportSource& source,
                                                  Diagnostics& diagnostics) const = 0;
};

}  // namespace alhazen
