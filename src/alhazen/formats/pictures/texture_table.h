#pragma once
/// Reads the images that a scene uses as textures, files or embedded, each once: textures with
/// different settings share the image.
///
/// Conventions: an unusable image is reported once, at its first use, and never yields a texture.
/// The size of each image is bounded by the given limits, and the memory of all together by
/// ImageLimits::max_bytes, checked before allocation: the stored samples, the mip levels of
/// mipmapped textures (MipPyramid; twice for an image used both as colour and as data), the encoded
/// bytes of embedded images, and temporarily the file and the decoder buffers of the current image.

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

/// The folders from which a scene may read files: its own and options.allowed_folders.
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
    /// `settings`. Reports an error at `where` and returns none if the file is unusable. Throws
    /// Error (Resource) if all images together exceed the limit.
    std::optional<TextureId> load(const std::string& file, const std::filesystem::path& folder,
                                  const ImageTexture& settings, std::string name,
                                  const FileLocation& where);

    /// The texture of an image embedded in the scene's bytes, `encoded` as in an image file. Images
    /// are identified by the address of their bytes, which must stay valid for the lifetime of the
    /// table. Otherwise as `load`.
    std::optional<TextureId> add(std::string_view encoded, const ImageTexture& settings,
                                 std::string name, const FileLocation& where);

    /// Replaces the image of texture `id` by the result of `make`, three channels of 8-bit codes of
    /// the same size; computed once per image and `key`. Counts memory and throws as `load`.
    void derive(TextureId id, const std::string& key,
                const std::function<StoredImage(const StoredImage&)>& make);

  private:
    /// Reports a picture that cannot be read; throws for one beyond a limit, which ends the import
    /// (exit status 5).
    void report(const FileLocation& where, const Error& error);
    /// Warns of a picture without pixels in its display window.
    void warn_of_nothing(const StoredImage& picture, const FileLocation& where);
    struct Picture {
        std::shared_ptr<const StoredImage> image;  ///< null if unreadable
        /// True if the mip levels of the stored samples [0] or of the decoded samples [1] are
        /// counted.
        bool counted_pyramid[2] = {false, false};
    };

    /// Runs `decode` with the limits left and counts the memory of its result.
    template <class Decode>
    std::shared_ptr<const StoredImage> decoded(const Decode& decode);
    /// Throws if `bytes` exceeds the memory left.
    void count(std::uint64_t bytes, const std::string& name);

    std::optional<TextureId> use(Picture& picture, const ImageTexture& settings, std::string name,
                                 const FileLocation& where);

    SceneDescription& scene_;
    Diagnostics& diagnostics_;
    std::vector<std::filesystem::path> roots_;
    ImageLimits limits_;
    std::uint64_t taken_bytes_ = 0;
    /// Keyed by resolved path, and by address and size.
    std::map<std::filesystem::path, Picture> files_;
    std::map<std::pair<const char*, std::size_t>, Picture> embedded_;
    /// Keyed by source image and key.
    std::map<std::pair<std::shared_ptr<const StoredImage>, std::string>,
             std::shared_ptr<const StoredImage>>
        derived_;
};

}  // namespace alhazen
