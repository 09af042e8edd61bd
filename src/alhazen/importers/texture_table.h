#pragma once
/// Reads the pictures that a scene uses as textures, files or embedded ones, each once: textures
/// with different settings share the picture.
///
/// Conventions: a picture that cannot be used is reported once, at its first use, and yields no
/// texture at any. Sizes are held to the limits given.

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>

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
    std::optional<TextureId> load(const std::string& file, const std::filesystem::path& folder,
                                  const Texture& settings, std::string name,
                                  const FileLocation& where);

    /// The texture of a picture that lies in the scene's own bytes, `encoded` as in a picture file.
    /// `key` tells pictures apart: the same key is the same picture. Otherwise as `load`.
    std::optional<TextureId> add(std::string_view encoded, const std::string& key,
                                 const Texture& settings, std::string name,
                                 const FileLocation& where);

  private:
    using Picture = std::shared_ptr<const StoredImage>;

    std::optional<TextureId> use(const Picture& picture, const Texture& settings, std::string name,
                                 const FileLocation& where);

    SceneDescription& scene_;
    Diagnostics& diagnostics_;
    std::filesystem::path root_;
    ImageLimits limits_;
    /// By resolved path, or by key; null for a picture that could not be read.
    std::map<std::filesystem::path, Picture> files_;
    std::map<std::string, Picture> embedded_;
};

}  // namespace alhazen
