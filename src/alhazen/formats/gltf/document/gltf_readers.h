#pragma once
/// The parts of `read_gltf_document`: first each top-level array is read from JSON into the
/// document, every reference checked against the size of what it refers to; then, when nothing was
/// wrong, the checks look at how the parts fit together and at the numbers in the buffers.

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "alhazen/formats/gltf/document/gltf_json.h"

namespace alhazen::gltf {

/// A document while it is read.
struct Loading : JsonContext {
    Loading(const ImportSource& from, Diagnostics& findings);

    const ImportSource& source;
    Document document;
    std::filesystem::path folder;              ///< of the file
    std::vector<std::filesystem::path> roots;  ///< files named by it must lie in one of them
    std::optional<std::string_view> binary;    ///< chunk of a GLB
    bool is_glb = false;
    bool quantized = false;  ///< KHR_mesh_quantization is used
};

// Readers: JSON to document. Each appends one element for each of the JSON array when there is no
// error.
void read_asset(const JsonObject& root);
/// Counts the top-level arrays, and finds what is not supported: false when that ends the reading.
[[nodiscard]] bool read_extensions(const JsonObject& root, Loading& loading);
void read_buffers(const JsonObject& root, Loading& loading);  ///< and buffer views
void read_accessors(const JsonObject& root, Loading& loading);
void read_textures(const JsonObject& root, Loading& loading);  ///< and images, samplers
void read_materials(const JsonObject& root, Loading& loading);
void read_meshes(const JsonObject& root, Loading& loading);
void read_cameras(const JsonObject& root, Loading& loading);
void read_lights(const JsonObject& root, Loading& loading);
void read_nodes(const JsonObject& root, Loading& loading);       ///< and scenes
void read_animations(const JsonObject& root, Loading& loading);  ///< and skins

// Checks of a document that was read without an error.
void check_layout(const Loading& loading);  ///< views in buffers, accessors in views, sparse order
void check_images(const Loading& loading);
void check_graph(const Loading& loading);
void check_meshes(const Loading& loading);
void check_skins_and_animations(const Loading& loading);
/// Only after check_layout has found nothing.
void check_data(const Loading& loading);

/// "#/meshes/3", or with a part below it "#/meshes/3/primitives/1".
[[nodiscard]] std::string pointer_to(const char* collection, std::size_t position);
[[nodiscard]] std::string pointer_to(const char* collection, std::size_t position, const char* part,
                                     std::size_t part_position);

}  // namespace alhazen::gltf
