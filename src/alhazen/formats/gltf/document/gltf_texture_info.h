#pragma once
/// References of materials to textures.
///
/// Source: "glTF 2.0 Specification", 2021, section 5.30 (textureInfo); KHR_texture_transform.

#include <optional>
#include <string_view>

#include "alhazen/formats/gltf/document/gltf_readers.h"

namespace alhazen::gltf {

/// Largest index of a texture coordinate set.
inline constexpr std::uint64_t kMaxTexCoord = 1'000'000;

/// Reads the member `key` of a material. `strength`: name of the texture's factor ("scale" of a
/// normal texture, "strength" of an occlusion texture), or empty.
[[nodiscard]] std::optional<TextureInfo> read_texture_info(const JsonObject& owner,
                                                           std::string_view key,
                                                           std::string_view strength = {});

}  // namespace alhazen::gltf
