#pragma once
/// Image textures.

#include <cstdint>
#include <memory>
#include <string>

#include "alhazen/imaging/codecs/stored_image.h"
#include "alhazen/math/vec.h"
#include "alhazen/shading/textures/mip_pyramid.h"

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
    /// The same without the offset, for differences of coordinates.
    [[nodiscard]] Vec2 linear(const Vec2& p) const {
        return {uu * p.x + uv * p.y, vu * p.x + vv * p.y};
    }
    friend bool operator==(const UvTransform&, const UvTransform&) = default;
};

/// What a ray sees of a texture: the ellipse that its cone cuts out of the surface, as two of its
/// diameters in texture coordinates that are conjugate (an affine image of perpendicular ones).
/// Both zero: a point.
struct UvFootprint {
    Vec2 a{0, 0}, b{0, 0};
};

/// An image looked up by texture coordinates: u from left to right, v from bottom to top.
struct Texture {
    std::shared_ptr<const StoredImage> image;  ///< never null in a compiled scene
    Wrap wrap_u = Wrap::Repeat;
    Wrap wrap_v = Wrap::Repeat;
    TextureFilter filter = TextureFilter::Bilinear;
    /// Texel positions: false = texel centres at (i + 0.5) / width (the usual rule); true = the
    /// course's rule, texel i at i / (width - 1).
    bool corner_texels = false;
    bool decode_srgb = false;  ///< samples are sRGB encoded and must be made linear
    int uv_set = 0;            ///< which texture coordinates of a mesh: 0 or 1
    UvTransform uv_transform;
    /// Of `image`; made by `compile` for Mipmapped. Null: looked up as Bilinear.
    std::shared_ptr<const MipPyramid> pyramid;
};

/// The texture's linear colour and alpha at `uv`, which uv_transform has been applied to; the mean
/// over the footprint when mipmapped.
///
/// Source: Heckbert, "Survey of Texture Mapping", IEEE CG&A 6(11), 1986 (the footprint as an
/// ellipse); McCormack, Perry, Farkas and Jouppi, "Feline: Fast Elliptical Lines for Anisotropic
/// Texture Mapping", SIGGRAPH 1999 (probes along its long axis).
/// Differs: probes weigh the same, as the pixel they stand for is a box; at most 16 of them, beyond
/// which the short axis is taken longer.
[[nodiscard]] Rgba evaluate(const Texture& texture, const Vec2& uv,
                            const UvFootprint& footprint = {});

}  // namespace alhazen
