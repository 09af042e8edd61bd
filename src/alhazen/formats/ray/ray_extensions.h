#pragma once
/// Student extensions of the SBT-raytracer format that are recognised by name but not supported.
/// They are rejected with a message that names the extension.

#include <optional>
#include <string>
#include <string_view>

namespace alhazen {

/// The name of the extension, such as "metaballs (HKUST)", of an object or light; none for an
/// unknown name.
[[nodiscard]] std::optional<std::string_view> ray_extension(std::string_view name);
/// The name of the extension of a material key.
[[nodiscard]] std::optional<std::string_view> ray_material_extension(std::string_view key);
/// True if only the dictionary family (docs/reference/formats/ray.md) has an object or light of
/// that name.
[[nodiscard]] bool is_dictionary_extension(std::string_view name);

/// A message such as "object 'metaball' is an extension (metaballs, HKUST) and is not supported".
[[nodiscard]] std::string refusal(std::string_view kind, std::string_view name,
                                  std::string_view extension);

}  // namespace alhazen
