#pragma once
/// Reads the pictures that a scene uses as textures, files or embedded ones, each once: textures
/// with different settings share the picture.
///
/// Conventions: a picture that cannot be used is reported once, at its first use, and yields no
/// texture at any. Sizes of each picture are held to the limits given, and the memory of all
/// together to ImageLimits::max_bytes, before it is allocated: the samples as they are stored, the
/// smaller copies that mipmapped textures will have (MipPyramid; twice when a picture is shown both
/// as colour and as data), the encoded bytes of embedded pictures, and for the moment the file and
/// the decoder's buffers of the picture that is being read.

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "alhazen/formats/core/importer.h"

namespace alhazen {

/// The folders whose files a scene may name: its own, and those of options.allowed_folders.
[[nodiscard]] std::vector<std::filesystem::path> scene_roots(const ImportOptions& options,
                                                             const std::filesystem::path& own);
/// The absolute folder of a scene file.
[[nodiscard]] std::filesystem::path folder_of(const std::filesystem::path& scene_file);

class TextureTable {
  public:
    TextureTable(SceneDescription& scene, Diagnostics& diagnostics,
                 std::vector<std::filesystem::path> roots, const ImageLimits& limits = {})
        : scene_(scene), diagnostics_(diagnostics), roots_(std::move(roots)), limits_(limits) {}

    /// The texture of `file`, as written in a scene file in `folder`, with the other fields of
    /// `settings`. Reports an error at `where` and returns nothing when the file cannot be used.
    /// Throws Error (Resource) when all pictures together take more than the limit.
    std::optional<TextureId> load(const std::string& file, const std::filesystem::path& folder,
                                  const Texture& settings, std::string name,
                                  const FileLocation& where);

    /// The texture of a picture that lies in the scene's own bytes, `encoded` as in a picture file.
    /// Pictures are told apart by where they lie: the bytes must stay there while the table lives.
    /// Otherwise as `load`.
    std::optional<TextureId> add(std::string_view encoded, const Texture& settings,
                                 std::string name, const FileLocation& where);

    /// Replaces the picture of texture `id` by what `make` makes of it, three channels of 8-bit
    /// codes of the same size; made once for each picture and `key`. Counts and throws as `load`.
    void derive(TextureId id, const std::string& key,
                const std::function<StoredImage(const StoredImage&)>& make);

  private:
    struct Picture {
        std::shared_ptr<const StoredImage> image;  ///< null when it could not be read
        /// Whether the smaller copies are counted: of the samples as they are, and decoded.
        bool counted_pyramid[2] = {false, false};
    };

    /// What `decode` makes of a picture within the limits that it is given; counts it.
    template <class Decode>
    std::shared_ptr<const StoredImage> decoded(const Decode& decode);
    /// Throws when it is more than what is left.
    void count(std::uint64_t bytes, const std::string& name);

    std::optional<TextureId> use(Picture& picture, const Texture& settings, std::string name,
                                 const FileLocation& where);

    SceneDescription& scene_;
    Diagnostics& diagnostics_;
    std::vector<std::filesystem::path> roots_;
    ImageLimits limits_;
    std::uint64_t taken_bytes_ = 0;
    /// By resolved path, or by place.
    std::map<std::filesystem::path, Picture> files_;
    std::map<std::pair<const char*, std::size_t>, Picture> embedded_;
    /// By what it was made of, and how.
    std::map<std::pair<std::shared_ptr<const StoredImage>, std::string>,
             std::shared_ptr<const StoredImage>>
        derived_;
};

}  // namespace alhazen
