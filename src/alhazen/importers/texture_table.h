#pragma once
/// Reads the pictures that a scene uses as textures, files or embedded ones, each once: textures
/// with different settings share the picture.
///
/// Conventions: a picture that cannot be used is reported once, at its first use, and yields no
/// texture at any. Sizes are held to the limits given: of each picture, and of all together, where
/// a pixel of 8-bit codes counts once, of 16-bit codes twice and of floats four times: at most 4
/// bytes each (1 GiB by default), and at most two thirds more for smaller copies (MipPyramid). An
/// embedded picture counts at least a quarter of its encoded bytes, as bytes can be shared.

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "alhazen/importers/importer.h"

namespace alhazen {

/// The folder whose files a scene may name: options.allowed_root, else `fallback`.
[[nodiscard]] std::filesystem::path scene_root(const ImportOptions& options,
                                               const std::filesystem::path& fallback);
/// The absolute folder of a scene file.
[[nodiscard]] std::filesystem::path folder_of(const std::filesystem::path& scene_file);

class TextureTable {
  public:
    TextureTable(SceneDescription& scene, Diagnostics& diagnostics, std::filesystem::path root,
                 const ImageLimits& limits = {})
        : scene_(scene), diagnostics_(diagnostics), root_(std::move(root)), limits_(limits) {}

    /// The texture of `file`, as written in a scene file in `folder`, with the other fields of
    /// `settings`. Reports an error at `where` and returns nothing when the file cannot be used.
    /// Throws Error (Resource) when all pictures together exceed the limit.
    std::optional<TextureId> load(const std::string& file, const std::filesystem::path& folder,
                                  const Texture& settings, std::string name,
                                  const FileLocation& where);

    /// The texture of a picture that lies in the scene's own bytes, `encoded` as in a picture file.
    /// Pictures are told apart by where they lie: the bytes must stay there while the table lives.
    /// Otherwise as `load`.
    std::optional<TextureId> add(std::string_view encoded, const Texture& settings,
                                 std::string name, const FileLocation& where);

  private:
    using Picture = std::shared_ptr<const StoredImage>;

    /// What `decode` makes of a picture within the limits that it is given; counts it, at least
    /// with `least`.
    template <class Decode>
    Picture decoded(const Decode& decode, std::uint64_t least = 0);

    std::optional<TextureId> use(const Picture& picture, const Texture& settings, std::string name,
                                 const FileLocation& where);

    SceneDescription& scene_;
    Diagnostics& diagnostics_;
    std::filesystem::path root_;
    ImageLimits limits_;
    std::uint64_t taken_pixels_ = 0;
    /// By resolved path, or by place; null for a picture that could not be read.
    std::map<std::filesystem::path, Picture> files_;
    std::map<std::pair<const char*, std::size_t>, Picture> embedded_;
};

}  // namespace alhazen
