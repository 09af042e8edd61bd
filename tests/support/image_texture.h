#pragma once
/// The image texture of a description; throws std::bad_variant_access for a texture of another
/// kind.

#include <variant>

#include "alhazen/scene_model/scene_description.h"

namespace alhazen::testing {

inline const ImageTexture& image_texture(const TextureDescription& description) {
    return std::get<ImageTexture>(description.texture);
}

}  // namespace alhazen::testing
