#pragma once
/// The names of vertex attributes and what their accessors may hold.
///
/// Source: "glTF 2.0 Specification", 2021, sections 3.7.2.1 and 3.7.2.2; KHR_mesh_quantization,
/// tables of extended attribute types.
/// Differs: nothing.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "alhazen/formats/gltf/document/gltf_document.h"

namespace alhazen::gltf {

/// "TEXCOORD_1" taken apart.
struct Semantic {
    std::string_view name;             ///< "TEXCOORD"
    std::optional<std::uint32_t> set;  ///< 1; none for names without a number
    bool is_custom = false;            ///< begins with an underscore; then name is all of it
};

/// Nothing for a name that is neither of the specification nor begins with an underscore.
[[nodiscard]] std::optional<Semantic> parse_semantic(std::string_view attribute);

/// Whether an accessor can be this attribute of a vertex, or of a morph target.
[[nodiscard]] bool suits(const Semantic& semantic, const Accessor& accessor, bool is_target,
                         bool quantized);

}  // namespace alhazen::gltf
