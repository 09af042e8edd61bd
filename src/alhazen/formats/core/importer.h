#pragma once
/// Bytes in, scene description and diagnostics out. To add a format: CONTRIBUTING.md.

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
    /// Files named by the scene are looked for relative to the scene file. They must lie inside its
    /// own folder (or what the format prescribes) or one of these, symbolic links followed.
    std::vector<std::filesystem::path> allowed_folders;
    int max_nesting = 256;  ///< of blocks and groups in text formats
    int max_include_depth = 16;
    std::uint64_t max_included_bytes = std::uint64_t{1} << 32;
    /// Vertices, triangles or primitives in one file. glTF counts what it reads: elements of
    /// accessors, once for each use (a mesh read for two sets of morph weights counts twice). JSON
    /// values: a twentieth of this, or a million.
    std::uint64_t max_elements = 400'000'000;
    /// Memory for the meshes and parts that a glTF file makes, also of shared data by morph
    /// weights, skins and instances; none: 64 MiB and 64 times the bytes of the file and its
    /// buffers, at most 16 GiB.
    std::optional<std::uint64_t> max_made_bytes;
    ImageLimits image_limits;  ///< of each texture
    std::optional<double>
        time;  ///< seconds: animations of the file are applied at this time; none: as at rest
    std::string animation;  ///< name or position of the only animation to apply; empty: all
    std::vector<std::string> objects;   ///< names of what is to be seen; none: all of the file
    std::filesystem::path view_script;  ///< a file of views beside the scene; empty: none
};

/// What an importer is given: the file's bytes (already read) and where they came from.
struct ImportSource {
    std::string_view bytes;
    std::filesystem::path path;  ///< used in locations and to resolve the names of other files
    const ImportOptions& options;
};

class Importer {
  public:
    virtual ~Importer() = default;
    [[nodiscard]] virtual const char* name() const = 0;         ///< as in `alhazen list formats`
    [[nodiscard]] virtual const char* description() const = 0;  ///< one line
    /// How sure the importer is that the bytes are its format: 0 no, 1 by the suffix only, 2 by the
    /// content.
    [[nodiscard]] virtual int recognise(const ImportSource& source) const = 0;
    /// Makes only what `ImportOptions::objects` names; of other formats it is chosen afterwards.
    [[nodiscard]] virtual bool chooses_objects() const { return false; }
    /// Whether `ImportOptions::view_script` is for this format.
    [[nodiscard]] virtual bool reads_view_scripts() const { return false; }
    /// Reads all that can be read. Findings go to `diagnostics`; the result is only used when none
    /// is an error. Throws Error only for limits (Resource) and for files that cannot be read.
    [[nodiscard]] virtual SceneDescription import(const ImportSource& source,
                                                  Diagnostics& diagnostics) const = 0;
};

}  // namespace alhazen
