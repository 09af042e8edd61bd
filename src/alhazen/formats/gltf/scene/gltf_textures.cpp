#include "alhazen/formats/gltf/scene/gltf_textures.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <vector>

namespace alhazen::gltf {

namespace {

std::string name_of(const Image& image, Index index) {
    if (!image.name.empty()) return image.name;
    if (!image.uri.empty()) return image.uri;
    return fmt::format("image {}", index);
}

/// 1 - `glossiness` times the alpha, repeated in three channels, as codes of 8 bits.
StoredImage roughness_of_gloss(const StoredImage& picture, double glossiness) {
    StoredImage result;
    result.width = picture.width;
    result.height = picture.height;
    result.linear = false;
    std::vector<std::uint8_t> codes;
    const std::size_t pixels = std::size_t(picture.width) * std::size_t(picture.height);
    codes.reserve(3 * pixels);
    for (std::size_t i = 0; i < pixels; ++i) {
        const double roughness = 1.0 - glossiness * picture.pixel(i, false).a;
        codes.insert(codes.end(), 3, static_cast<std::uint8_t>(std::lround(255.0 * roughness)));
    }
    result.samples = std::move(codes);
    return result;
}

}  // namespace

UvTransform uv_transform(const TextureInfo& info) {
    // (s', t') = offset + R S (s, t), t downward; a positive angle turns counter-clockwise as seen.
    const double c = std::cos(info.rotation), s = std::sin(info.rotation);
    const double ss = c * info.scale[0], st = s * info.scale[1];
    const double ts = -s * info.scale[0], tt = c * info.scale[1];
    // Substitute v = 1 - t on both sides.
    UvTransform result;
    result.uu = ss;
    result.uv = -st;
    result.vu = -ts;
    result.vv = tt;
    result.offset = {st + info.offset[0], 1.0 - tt - info.offset[1]};
    return result;
}

TextureFilter filter_of(const Sampler& sampler) {
    if (sampler.minify != Filter::Nearest) {
        // Minified without mipmaps: those of the pyramid have no aliases.
        if (sampler.magnify == Filter::Nearest) return TextureFilter::NearestMipmapped;
        return sampler.minify == Filter::Linear ? TextureFilter::Bilinear
                                                : TextureFilter::Mipmapped;
    }
    return sampler.magnify == Filter::Nearest ? TextureFilter::Nearest : TextureFilter::Bilinear;
}

Textures::Textures(const Document& document, const ImportSource& source, SceneDescription& scene,
                   Diagnostics& diagnostics)
    : document_(document),
      source_(source),
      diagnostics_(diagnostics),
      table_(scene, diagnostics, scene_roots(source.options, folder_of(source.path)),
             source.options.image_limits) {}

TextureId Textures::use(const std::optional<TextureInfo>& info, ColorSpace space) {
    if (!info) return kNoTexture;
    const Key key{info->texture, info->tex_coord, info->offset, info->scale, info->rotation, space};
    const auto [entry, fresh] = made_.try_emplace(key, kNoTexture);
    if (fresh) entry->second = make(*info, space);
    return entry->second;
}

TextureId Textures::use_as_roughness(const std::optional<TextureInfo>& info, double glossiness) {
    if (!info) return kNoTexture;
    const Key key{info->texture, info->tex_coord, info->offset,
                  info->scale,   info->rotation,  ColorSpace::Linear};
    const auto [entry, fresh] = made_of_gloss_.try_emplace({key, glossiness}, kNoTexture);
    if (fresh) {
        entry->second = make(*info, ColorSpace::Linear);
        if (entry->second != kNoTexture) {
            table_.derive(entry->second, fmt::format("roughness {}", glossiness),
                          [&](const StoredImage& picture) {
                              return roughness_of_gloss(picture, glossiness);
                          });
        }
    }
    return entry->second;
}

TextureId Textures::make(const TextureInfo& info, ColorSpace space) {
    const FileLocation where{source_.path.string(), 0, 0};
    const Texture& texture = document_.textures[info.texture];
    if (!texture.source) {
        diagnostics_.warning(where, fmt::format("#/textures/{}: the texture has no image of a "
                                                "supported format; it is ignored",
                                                info.texture));
        return kNoTexture;
    }
    if (info.tex_coord > 1) {
        diagnostics_.warning(where, fmt::format("#/textures/{}: a material uses TEXCOORD_{}; only "
                                                "0 and 1 are supported, 0 is used",
                                                info.texture, info.tex_coord));
    }
    const Sampler sampler = texture.sampler ? document_.samplers[*texture.sampler] : Sampler{};
    ImageTexture settings;
    settings.wrap_u = sampler.wrap_s;
    settings.wrap_v = sampler.wrap_t;
    settings.filter = filter_of(sampler);
    settings.decode_srgb = space == ColorSpace::Srgb;
    settings.uv_set = info.tex_coord == 1 ? 1 : 0;
    settings.uv_transform = uv_transform(info);
    const Index index = *texture.source;
    const Image& image = document_.images[index];
    const std::string name = name_of(image, index);
    std::optional<TextureId> id;
    if (!image.uri.empty()) {
        id = table_.load(image.uri, folder_of(source_.path), settings, name, where);
    } else {
        const std::string_view bytes =
            image.view ? bytes_of(document_, document_.views[*image.view]) : image.data;
        id = table_.add(bytes, settings, name, where);
    }
    return id.value_or(kNoTexture);
}

}  // namespace alhazen::gltf
