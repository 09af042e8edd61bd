#include "alhazen/formats/gltf/document/gltf_glb.h"

#include <cstdint>

namespace alhazen::gltf {

namespace {

constexpr std::uint32_t kJsonChunk = 0x4E4F534A, kBinaryChunk = 0x004E4942;

std::uint32_t word_at(std::string_view bytes, std::size_t offset) {
    std::uint32_t word = 0;
    for (std::size_t i = 0; i < 4; ++i) {
        word |= std::uint32_t{static_cast<unsigned char>(bytes[offset + i])} << (8 * i);
    }
    return word;
}

/// Splits the container; returns the error message, empty on success.
std::string split(std::string_view bytes, Container& out) {
    if (bytes.size() < 12) return "the header is cut off";
    const std::uint32_t version = word_at(bytes, 4);
    if (version != 2) return "expected version 2, found " + std::to_string(version);
    const std::uint32_t length = word_at(bytes, 8);
    if (length != bytes.size()) {
        return "the header gives a length of " + std::to_string(length) + " bytes, the file has " +
               std::to_string(bytes.size());
    }
    bool has_json = false;
    std::size_t position = 12;
    for (int number = 0; position < bytes.size(); ++number) {
        const std::string chunk = "chunk " + std::to_string(number);
        if (bytes.size() - position < 8) return "the header of " + chunk + " is cut off";
        const std::size_t size = word_at(bytes, position);
        const std::uint32_t type = word_at(bytes, position + 4);
        position += 8;
        if (size > bytes.size() - position) {
            return chunk + " has " + std::to_string(size) + " bytes, only " +
                   std::to_string(bytes.size() - position) + " are left";
        }
        if (size % 4 != 0) return "the length of " + chunk + " is not a multiple of 4";
        if (number == 0 && type != kJsonChunk) return "the first chunk is not the JSON chunk";
        const std::string_view content = bytes.substr(position, size);
        if (type == kJsonChunk) {
            if (has_json) return chunk + " is a second JSON chunk";
            if (size == 0) return "the JSON chunk is empty";
            has_json = true;
            out.json = content;
        } else if (type == kBinaryChunk) {
            if (out.binary) return chunk + " is a second binary chunk";
            if (number != 1) return "the binary chunk is not the second one";
            out.binary = content;
        }
        position += size;
    }
    return has_json ? "" : "there is no JSON chunk";
}

}  // namespace

bool is_glb(std::string_view bytes) {
    return bytes.substr(0, 4) == "glTF";
}

std::optional<Container> open_container(std::string_view bytes, const std::string& file,
                                        Diagnostics& diagnostics) {
    Container container;
    if (!is_glb(bytes)) {
        container.json = bytes;
        return container;
    }
    container.is_glb = true;
    const std::string refusal = split(bytes, container);
    if (refusal.empty()) return container;
    diagnostics.error({file, 0, 0}, "GLB: " + refusal);
    return std::nullopt;
}

}  // namespace alhazen::gltf
