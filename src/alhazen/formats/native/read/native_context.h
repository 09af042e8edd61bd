#pragma once
/// State that the functions of the native importer share while a scene is read, including the
/// current position in it.

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "alhazen/formats/core/importer.h"
#include "alhazen/formats/pictures/texture_table.h"
#include "alhazen/formats/text/block_reader.h"
#include "alhazen/formats/text/first_names.h"

namespace alhazen {

struct NativeContext {
    NativeContext(SceneDescription& scene_, Diagnostics& diagnostics_,
                  const ImportOptions& options_);

    SceneDescription& scene;
    Diagnostics& diagnostics;
    const ImportOptions& options;
    std::vector<std::filesystem::path> roots;  ///< folders of files that may be named
    TextureTable textures;

    // Names defined so far; a name must be defined before it is used.
    std::map<std::string, MaterialId, std::less<>> material_names;
    std::map<std::string, TextureId, std::less<>> texture_names;
    std::map<std::string, MeshIndex, std::less<>> geometry_names;
    std::map<std::string, ObjectIndex, std::less<>> object_names;
    /// Objects that are numbered but not yet defined, and where they are listed.
    std::map<std::string, FileLocation, std::less<>> listed_objects;
    std::optional<MaterialId> built_in_material;

    std::vector<std::size_t> cameras_without_aspect;  ///< get the aspect ratio of the image
    std::vector<std::filesystem::path>
        open_files;                ///< the file being read and those that include it
    std::filesystem::path folder;  ///< of the file whose top level is being read
    std::uint64_t included_bytes = 0;
    std::uint64_t included_files = 0;
    std::uint64_t elements = 0;         ///< number of vertices, triangles and parts
    BlockObserver* observer = nullptr;  ///< observes all blocks; may be null

    [[nodiscard]] BlockReader reader(TextNode block, std::string what) const {
        BlockReader made(block, std::move(what), BlockReader::Strictness::Strict, diagnostics);
        made.observe(observer);
        return made;
    }
    /// Throws Error (Resource) beyond options.max_elements.
    void count_elements(std::uint64_t more, const FileLocation& where);
};

/// The target of new items, and the settings in force there.
struct NativeScope {
    std::vector<Part>& parts;
    Affine object_from_here;
    std::optional<MaterialId> material;  ///< default of parts without one
    std::filesystem::path folder;        ///< of the file being read
    int nesting = 0;  ///< number of enclosing objects and groups, through all included files
    RayMask visible_to = kAllRays;  ///< kinds of rays to which all enclosing groups are visible

    [[nodiscard]] bool top_level() const { return nesting == 0; }
    /// The transform of this scope times `here_from_part`. A single transform is kept bit for bit:
    /// multiplication by the identity would turn -0 into 0.
    [[nodiscard]] Affine placed(const Affine& here_from_part) const {
        return object_from_here == Affine{} ? here_from_part : object_from_here * here_from_part;
    }
};

/// The parts of `type "name" { ... }`.
struct NativeBlock {
    std::string type, name;
    std::optional<TextNode> block;
    FileLocation location;
};
/// Splits an entry; reports an error if it has no block. Never throws.
[[nodiscard]] NativeBlock take_apart(TextNode entry, Diagnostics& diagnostics);

/// Defines `name` in `names`, or reports that it is already defined.
template <class Id>
void define_name(const std::string& name, Id id, const char* kind, const FileLocation& where,
                 std::map<std::string, Id, std::less<>>& names, Diagnostics& diagnostics) {
    if (!names.emplace(name, id).second) {
        diagnostics.error(where,
                          std::string(kind) + " \"" + printable(name) + "\" is already defined");
    }
}

/// The id of the name `value`; for an unknown name an error that lists the defined names.
template <class Id>
std::optional<Id> look_up(TextNode value, const char* kind,
                          const std::map<std::string, Id, std::less<>>& names,
                          Diagnostics& diagnostics) {
    const auto found = names.find(value.text());
    if (found != names.end()) return found->second;
    diagnostics.error(
        value.location(),
        std::string(kind) + " \"" + printable(value.text()) + "\" is not defined" +
            (names.empty() ? " before its use" : "; defined are " + first_names(names)));
    return std::nullopt;
}

/// A block of the top level: a camera, a light or settings.
struct NativeTopBlock {
    std::string_view name;
    void (*read)(const NativeBlock&, NativeContext&);
};

}  // namespace alhazen
