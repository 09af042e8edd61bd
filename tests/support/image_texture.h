#pragma once
/// Image textures of tests.

#include <memory>
#include <utility>
#include <variant>

#include "alhazen/scene_model/scene_description.h"

namespace alhazen::testing {

/// The image texture of a description. Throws std::bad_variant_access for another kind of texture.
inline const ImageTexture& image_texture(const TextureDescription& description) {
    return std::get<ImageTexture>(description.texture);
}

/// Red on the left, green on the right.
inline ImageTexture red_and_green(TextureFilter filter = TextureFilter::Nearest) {
    Image image(2, 1, 3);
    image.pixel(0, 0)[0] = image.pixel(1, 0)[1] = 1.0f;
    ImageTexture texture;
    texture.image = std::make_shared<const StoredImage>(stored(std::move(image)));
    texture.filter = filter;
    return texture;
}

}  // namespace alhazen::testing
