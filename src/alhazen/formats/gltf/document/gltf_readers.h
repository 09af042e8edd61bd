#pragma once
/// The stages of `read_gltf_document`. The readers convert each top-level array from JSON and check
/// every index against the size of its target. If they report no error, the checks verify the
/// relations between the parts and the numbers in the buffers.

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "alhazen/formats/gltf/document/gltf_json.h"

namespace alhazen::gltf {

/// State of a document during reading.
struct Loading : JsonContext {
    Loading(const ImportSource& from, Diagnostics& findings);

    const ImportSource& source;
    Document document;
    std::filesystem::path folder;              ///< of the file
    std::vector<std::filesystem::path> roots;  ///< external files must lie in one of them
    std::optional<std::string_view> binary;    ///< chunk of a GLB
    bool is_glb = false;
    bool quantized = false;  ///< KHR_mesh_quantization is used
};

// Readers: JSON to document. If there is no error, each appends one element per element of the JSON
// array.
void read_asset(const JsonObject& root);
/// Counts the top-level arrays and reports unsupported extensions; false if reading must stop.
[[nodiscard]] bool read_extensions(const JsonObject& root, Loading& loading);
void read_buffers(const JsonObject& root, Loading& loading);  ///< also reads buffer views
void read_accessors(const JsonObject& root, Loading& loading);
void read_textures(const JsonObject& root, Loading& loading);   ///< also reads images and samplers
void read_materials(const JsonObject& root, Loading& loading);  ///< and variants
void read_meshes(const JsonObject& root, Loading& loading);
void read_cameras(const JsonObject& root, Loading& loading);
void read_lights(const JsonObject& root, Loading& loading);
void read_nodes(const JsonObject& root, Loading& loading);       ///< also reads scenes
void read_animations(const JsonObject& root, Loading& loading);  ///< also reads skins

// Checks of a document that was read without errors.
void check_layout(const Loading& loading);  ///< views in buffers, accessors in views, sparse order
void check_usage(const Loading& loading);   ///< each accessor and view has one use
void check_images(const Loading& loading);
void check_graph(const Loading& loading);
void check_meshes(const Loading& loading);
void check_skins_and_animations(const Loading& loading);
/// Precondition: check_layout has found no errors.
void check_data(const Loading& loading);

/// "#/meshes/3", or with a part "#/meshes/3/primitives/1".
[[nodiscard]] std::string pointer_to(const char* collection, std::size_t position);
[[nodiscard]] std::string pointer_to(const char* collection, std::size_t position, const char* part,
                                     std::size_t part_position);

}  // namespace alhazen::gltf
