#pragma once
/// The textures of a glTF document, each use a TextureDescription of its own; pictures are shared.
///
/// Source: Khronos, "glTF 2.0 Specification", 2021, sections 3.8 and 3.9; KHR_texture_transform.
/// Differs: a filter is one of ours: any mipmap, or nothing said, is Mipmapped.
/// Conventions: texture coordinates have v upward here, downward in the file; transforms are
/// restated for that.

#include <map>
#include <tuple>

#include "alhazen/formats/gltf/document/gltf_document.h"
#include "alhazen/formats/pictures/texture_table.h"

namespace alhazen::gltf {

/// Whether the colours of a picture are encoded for display.
enum class ColorSpace { Linear, Srgb };

/// KHR_texture_transform on our coordinates.
[[nodiscard]] UvTransform uv_transform(const TextureInfo& info);
[[nodiscard]] TextureFilter filter_of(const Sampler& sampler);

class Textures {
  public:
    Textures(const Document& document, const ImportSource& source, SceneDescription& scene,
             Diagnostics& diagnostics);

    /// kNoTexture when there is none or it cannot be read (then reported).
    [[nodiscard]] TextureId use(const std::optional<TextureInfo>& info, ColorSpace space);

  private:
    using Key =
        std::tuple<Index, Index, std::array<double, 2>, std::array<double, 2>, double, ColorSpace>;

    [[nodiscard]] TextureId make(const TextureInfo& info, ColorSpace space);

    const Document& document_;
    const ImportSource& source_;
    Diagnostics& diagnostics_;
    TextureTable table_;
    std::map<Key, TextureId> made_;
};

}  // namespace alhazen::gltf
