#pragma once
/// Reads the texture files that a scene names, each once.

#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "alhazen/importers/importer.h"

namespace alhazen {

/// The folder whose files a scene may name: options.allowed_root, else `fallback`.
[[nodiscard]] std::filesystem::path scene_root(const ImportOptions& options,
                                               const std::filesystem::path& fallback);
/// The absolute folder of a scene file.
[[nodiscard]] std::filesystem::path folder_of(const std::filesystem::path& scene_file);

class TextureTable {
  public:
    TextureTable(SceneDescription& scene, Diagnostics& diagnostics, std::filesystem::path root)
        : scene_(scene), diagnostics_(diagnostics), root_(std::move(root)) {}

    /// The texture of `file`, as written in a scene file in `folder`, with the other fields of
    /// `settings`. Reports an error at `where` and returns nothing when the file cannot be used.
    std::optional<TextureId> load(const std::string& file, const std::filesystem::path& folder,
                                  const Texture& settings, std::string name,
                                  const FileLocation& where);

  private:
    SceneDescription& scene_;
    Diagnostics& diagnostics_;
    std::filesystem::path root_;
    /// By resolved path; null for a file that could not be read (reported at its first use).
    std::map<std::filesystem::path, std::shared_ptr<const Image>> images_;
};

}  // namespace alhazen
