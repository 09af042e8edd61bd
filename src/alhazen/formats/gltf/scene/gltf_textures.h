#pragma once
/// Textures of a glTF document. Each distinct use becomes a TextureDescription; images are shared.
///
/// Source: Khronos, "glTF 2.0 Specification", 2021, sections 3.8 and 3.9; KHR_texture_transform.
/// Differs: filters map to TextureFilter; any mipmap filter, or none given, is Mipmapped.
/// Conventions: v runs upward here and downward in the file; transforms are converted accordingly.

#include <map>
#include <tuple>
#include <utility>

#include "alhazen/formats/gltf/document/gltf_document.h"
#include "alhazen/formats/pictures/texture_table.h"

namespace alhazen::gltf {

/// Colour encoding of an image.
enum class ColorSpace { Linear, Srgb };

/// KHR_texture_transform converted to upward v.
[[nodiscard]] UvTransform uv_transform(const TextureInfo& info);
[[nodiscard]] TextureFilter filter_of(const Sampler& sampler);

class Textures {
  public:
    Textures(const Document& document, const ImportSource& source, SceneDescription& scene,
             Diagnostics& diagnostics);

    /// The texture; kNoTexture if there is none or it cannot be read (reported).
    [[nodiscard]] TextureId use(const std::optional<TextureInfo>& info, ColorSpace space);

    /// A texture of 1 - `glossiness` times the alpha of the image, in all channels.
    [[nodiscard]] TextureId use_as_roughness(const std::optional<TextureInfo>& info,
                                             double glossiness);

  private:
    using Key =
        std::tuple<Index, Index, std::array<double, 2>, std::array<double, 2>, double, ColorSpace>;

    [[nodiscard]] TextureId make(const TextureInfo& info, ColorSpace space);

    const Document& document_;
    const ImportSource& source_;
    Diagnostics& diagnostics_;
    TextureTable table_;
    std::map<Key, TextureId> made_;
    std::map<std::pair<Key, double>, TextureId> made_of_gloss_;
};

}  // namespace alhazen::gltf
