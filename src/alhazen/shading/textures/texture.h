#pragma once
/// Textures: images looked up by texture coordinates, and solid textures (solid_texture.h).
///
/// ADD A TEXTURE HERE: a further kind is a struct with `evaluate`, in a file pair of its own, and a
/// member of `Texture` below. The compiler then reports: shading/materials/material.cpp,
/// scene/compile_materials.cpp, scene_model/validate_materials.cpp, formats/native/write/
/// native_write_materials.cpp, session/scene_info/info.cpp, session/conversion/convert.cpp and
/// tests/support/same_description.h. Its block is read in formats/native/read/native_materials.cpp.
/// A new Wrap or TextureFilter needs its case in texture.cpp and a word in
/// formats/native/native_words.h; session/scene_info/info.cpp names the filters.

#include <cstdint>
#include <memory>
#include <string>
#include <variant>

#include "alhazen/imaging/codecs/stored_image.h"
#include "alhazen/math/vec.h"
#include "alhazen/shading/textures/mip_pyramid.h"
#include "alhazen/shading/textures/solid_texture.h"

namespace alhazen {

enum class TextureId : std::uint32_t {};
inline constexpr TextureId kNoTexture{0xFFFFFFFFu};

/// Treatment of coordinates outside [0, 1].
enum class Wrap { Repeat, Clamp, Mirror };

/// Nearest texel; bilinear interpolation; trilinear in an image pyramid, by the ray's footprint; or
/// the same where a texel is no larger than the footprint, and the nearest texel where it is.
enum class TextureFilter { Nearest, Bilinear, Mipmapped, NearestMipmapped };
/// True for the filters that look up an image pyramid.
inline bool has_pyramid(TextureFilter filter) {
    return filter == TextureFilter::Mipmapped || filter == TextureFilter::NearestMipmapped;
}

/// Transform of texture coordinates before a lookup: (u', v') = (uu u + uv v + offset.x, vu u + vv
/// v + offset.y).
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

/// Footprint of a ray in a texture: the ellipse where its cone meets the surface, as two conjugate
/// diameters in texture coordinates. Both zero: a point.
struct UvFootprint {
    Vec2 a{0, 0}, b{0, 0};
};

/// An image looked up by texture coordinates: u from left to right, v from bottom to top.
struct ImageTexture {
    std::shared_ptr<const StoredImage> image;  ///< not null in a compiled scene
    Wrap wrap_u = Wrap::Repeat;
    Wrap wrap_v = Wrap::Repeat;
    TextureFilter filter = TextureFilter::Bilinear;
    /// Texel positions: false = texel centres at (i + 0.5) / width (the usual rule); true = the
    /// course's rule, texel i at i / width, with rows counted from the top.
    bool corner_texels = false;
    bool decode_srgb = false;  ///< samples are sRGB encoded and are decoded to linear
    int uv_set = 0;            ///< set of texture coordinates of a mesh: 0 or 1
    UvTransform uv_transform;
    /// Pyramid of `image`; built by `compile` where `has_pyramid`. Null: looked up as Bilinear.
    std::shared_ptr<const MipPyramid> pyramid;
};

/// The linear colour and alpha of an image at `uv`, to which uv_transform has been applied; the
/// mean over the footprint when mipmapped.
///
/// Source: Heckbert, "Survey of Texture Mapping", IEEE CG&A 6(11), 1986 (the footprint as an
/// ellipse); McCormack, Perry, Farkas and Jouppi, "Feline: Fast Elliptical Lines for Anisotropic
/// Texture Mapping", SIGGRAPH 1999 (probes along its long axis).
/// Differs: probes have equal weights (the pixel is a box); at most 16 of them, beyond which the
/// short axis is lengthened.
[[nodiscard]] Rgba evaluate(const ImageTexture& texture, const Vec2& uv,
                            const UvFootprint& footprint = {});

using Texture = std::variant<ImageTexture, SolidTexture>;

}  // namespace alhazen
