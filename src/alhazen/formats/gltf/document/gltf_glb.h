#pragma once
/// The binary container of glTF: a header, a JSON chunk and at most one binary chunk.
///
/// Source: "glTF 2.0 Specification", 2021, section 4, GLB File Format Specification. Chunks of
/// other types are skipped, as the specification requires.

#include <optional>
#include <string>
#include <string_view>

#include "alhazen/base/diagnostics.h"

namespace alhazen::gltf {

struct Container {
    std::string_view json;
    std::optional<std::string_view> binary;  ///< none: no binary chunk
    bool is_glb = false;
};

/// True if the bytes begin with the GLB magic.
[[nodiscard]] bool is_glb(std::string_view bytes);

/// The chunks of a GLB; for any other file, all bytes as JSON. The result refers to `bytes`.
/// Reports errors and then returns none.
[[nodiscard]] std::optional<Container> open_container(std::string_view bytes,
                                                      const std::string& file,
                                                      Diagnostics& diagnostics);

}  // namespace alhazen::gltf
