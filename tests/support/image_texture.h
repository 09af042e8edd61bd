#pragma once
/// Access to the image texture of a description. Throws std::bad_variant_access for another kind of
/// texture.

#include <variant>

#include "alhazen/scene_model/scene_description.h"

namespace alhazen::testing {

inline const ImageTexture& image_texture(const TextureDescription& description) {
    return std::get<ImageTexture>(description.texture);
}

}  // namespace alhazen::testing
