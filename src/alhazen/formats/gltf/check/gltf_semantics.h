#pragma once
/// Names of vertex attributes, and the types their accessors may have.
///
/// Source: "glTF 2.0 Specification", 2021, sections 3.7.2.1 and 3.7.2.2; KHR_mesh_quantization,
/// tables of extended attribute types.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "alhazen/formats/gltf/document/gltf_document.h"

namespace alhazen::gltf {

/// A parsed attribute name, for example "TEXCOORD_1".
struct Semantic {
    std::string_view name;             ///< "TEXCOORD"
    std::optional<std::uint32_t> set;  ///< 1; none for names without a number
    bool is_custom = false;            ///< begins with an underscore; `name` is then the whole name
};

/// Parses an attribute name; none if it is neither in the specification nor begins with an
/// underscore.
[[nodiscard]] std::optional<Semantic> parse_semantic(std::string_view attribute);

/// True if the accessor's types are allowed for this attribute of a vertex or of a morph target.
[[nodiscard]] bool suits(const Semantic& semantic, const Accessor& accessor, bool is_target,
                         bool quantized);

}  // namespace alhazen::gltf
