#pragma once
/// Image textures and colours that may come from one.

#include <cstdint>
#include <memory>
#include <string>

#include "alhazen/imaging/image.h"
#include "alhazen/math/vec.h"

namespace alhazen {

enum class TextureId : std::uint32_t {};
inline constexpr TextureId kNoTexture{0xFFFFFFFFu};

/// How coordinates outside [0, 1] are read.
enum class Wrap { Repeat, Clamp, Mirror };

/// An image looked up by texture coordinates: u from left to right, v from bottom to top.
struct Texture {
    std::shared_ptr<const Image> image;  ///< never null in a compiled scene
    Wrap wrap_u = Wrap::Repeat;
    Wrap wrap_v = Wrap::Repeat;
    bool bilinear = true;  ///< else the nearest texel
    /// Texel positions: false = texel centres at (i + 0.5) / width (the usual rule); true = the
    /// course's rule, texel i at i / (width - 1).
    bool corner_texels = false;
    bool decode_srgb = false;  ///< samples are sRGB encoded and must be made linear
};

/// The texture's colour at `uv`, linear interpolation of the four nearest texels when bilinear.
[[nodiscard]] Rgb evaluate(const Texture& texture, const Vec2& uv);

}  // namespace alhazen
