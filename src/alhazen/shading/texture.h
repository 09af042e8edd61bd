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

/// How a texel is found: the nearest one; between the four nearest; or from smaller copies of the
/// picture, chosen by how much of it the ray sees.
enum class TextureFilter { Nearest, Bilinear, Mipmapped };

/// Applied to texture coordinates before a lookup: (u', v') = (uu u + uv v + offset.x, vu u + vv v
/// + offset.y).
struct UvTransform {
    double uu = 1, uv = 0, vu = 0, vv = 1;
    Vec2 offset{0, 0};

    [[nodiscard]] Vec2 apply(const Vec2& p) const {
        return {uu * p.x + uv * p.y + offset.x, vu * p.x + vv * p.y + offset.y};
    }
    friend bool operator==(const UvTransform&, const UvTransform&) = default;
};

/// An image looked up by texture coordinates: u from left to right, v from bottom to top.
struct Texture {
    std::shared_ptr<const Image> image;  ///< never null in a compiled scene
    Wrap wrap_u = Wrap::Repeat;
    Wrap wrap_v = Wrap::Repeat;
    TextureFilter filter = TextureFilter::Bilinear;
    /// Texel positions: false = texel centres at (i + 0.5) / width (the usual rule); true = the
    /// course's rule, texel i at i / (width - 1).
    bool corner_texels = false;
    bool decode_srgb = false;  ///< samples are sRGB encoded and must be made linear
    int uv_set = 0;            ///< which texture coordinates of a mesh: 0 or 1
    UvTransform uv_transform;
};

/// The texture's colour at `uv`, linear interpolation of the four nearest texels when bilinear.
[[nodiscard]] Rgb evaluate(const Texture& texture, const Vec2& uv);

}  // namespace alhazen
