#pragma once
/// Reads glTF documents from text, with their findings.

#include <string>
#include <utility>

#include "alhazen/formats/gltf/document/gltf_document.h"
#include "unit/formats/gltf/gltf_text.h"

namespace alhazen::testing {

struct ReadDocument {
    std::string bytes;  ///< the document refers to them
    gltf::Document document;
    Diagnostics diagnostics;

    [[nodiscard]] bool is_good() const { return diagnostics.error_count() == 0; }
    /// All findings, one per line.
    [[nodiscard]] std::string findings() const {
        std::string text;
        for (const Diagnostic& d : diagnostics.all()) text += to_string(d) + "\n";
        return text;
    }
    [[nodiscard]] bool says(const std::string& part) const {
        return findings().find(part) != std::string::npos;
    }
};

inline ReadDocument read_gltf(std::string bytes, const ImportOptions& options = {}) {
    ReadDocument result;
    result.bytes = std::move(bytes);
    const ImportSource source{result.bytes, "folder/scene.gltf", options};
    result.document = gltf::read_gltf_document(source, result.diagnostics);
    return result;
}

/// A file with only a version and these members.
inline std::string gltf_with(const std::string& members) {
    return R"({"asset": {"version": "2.0"}, )" + members + "}";
}

/// Replaces single quotes by double ones.
inline std::string json(std::string text) {
    for (char& c : text) c = c == '\'' ? '"' : c;
    return text;
}

}  // namespace alhazen::testing
