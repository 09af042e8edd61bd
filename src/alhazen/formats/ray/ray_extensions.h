#pragma once
/// Student extensions of the SBT-raytracer format that are recognised by name but not supported:
/// they are rejected with a message that names the extension.

#include <optional>
#include <string>
#include <string_view>

namespace alhazen {

/// "metaballs (HKUST)" for an object or light of an extension; none for an unknown name.
[[nodiscard]] std::optional<std::string_view> ray_extension(std::string_view name);
/// The same for a material key.
[[nodiscard]] std::optional<std::string_view> ray_material_extension(std::string_view key);
/// True when only the dictionary family (docs/reference/formats/ray.md) has an object or light of
/// that name.
[[nodiscard]] bool is_dictionary_extension(std::string_view name);

/// "object 'metaball' is an extension (metaballs, HKUST) and is not supported".
[[nodiscard]] std::string refusal(std::string_view kind, std::string_view name,
                                  std::string_view extension);

}  // namespace alhazen
