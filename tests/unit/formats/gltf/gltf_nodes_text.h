#pragma once
/// Text of a glTF file with a few nodes, for the tests of scenes, materials and views.

#include <string>

#include "unit/formats/gltf/gltf_text.h"

namespace alhazen::testing {

/// A file with one triangle as mesh 0 and these nodes; its scene has the nodes `shown`.
inline std::string with_nodes(const std::string& nodes, const std::string& shown = "0",
                              const std::string& more = "") {
    GltfText t;
    const int p = t.floats("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0}, bounds("0, 0, 0", "1, 1, 0"));
    return t.file(R"("scenes": [{"nodes": [)" + shown + R"(]}], "nodes": [)" + nodes +
                  R"(], "meshes": [{"name": "tri", "primitives": [{"attributes": {"POSITION": )" +
                  std::to_string(p) + "}}]}]" + more);
}

}  // namespace alhazen::testing
