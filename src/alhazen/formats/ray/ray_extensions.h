#pragma once
/// What students added to the SBT-raytracer format and we know by name but do not read: such a
/// thing is refused, and the message says what it is.

#include <optional>
#include <string>
#include <string_view>

namespace alhazen {

/// "metaballs (HKUST)" for an object or light of an extension; nothing for an unknown name.
[[nodiscard]] std::optional<std::string_view> ray_extension(std::string_view name);
/// The same for a key of a material.
[[nodiscard]] std::optional<std::string_view> ray_material_extension(std::string_view key);
/// True when only the dictionary family (docs/reference/formats/ray.md) has an object or light of
/// that name.
[[nodiscard]] bool is_dictionary_extension(std::string_view name);

/// "object 'metaball' is an extension (metaballs, HKUST) and is not supported".
[[nodiscard]] std::string refusal(std::string_view kind, std::string_view name,
                                  std::string_view extension);

}  // namespace alhazen
