#pragma once
/// The binary container of glTF: a header, a chunk of JSON and at most one chunk of bytes.
///
/// Source: "glTF 2.0 Specification", 2021, section 4, GLB File Format Specification.
/// Differs: nothing. Chunks of other types are skipped, as it asks.

#include <optional>
#include <string>
#include <string_view>

#include "alhazen/base/diagnostics.h"

namespace alhazen::gltf {

struct Container {
    std::string_view json;
    std::optional<std::string_view> binary;  ///< none: there is no such chunk
    bool is_glb = false;
};

/// Whether the bytes begin as a GLB file does.
[[nodiscard]] bool is_glb(std::string_view bytes);

/// The parts of a GLB, or all of the bytes as JSON for another file; views into `bytes`. Reports
/// what is wrong and then returns nothing.
[[nodiscard]] std::optional<Container> open_container(std::string_view bytes,
                                                      const std::string& file,
                                                      Diagnostics& diagnostics);

}  // namespace alhazen::gltf
