// One small file for each error code of Khronos' validator: all are refused, except those that
// docs/reference/formats/gltf_validator.md lists as milder.
#include <gtest/gtest.h>

#include <concepts>
#include <limits>

#include "unit/formats/gltf/gltf_read.h"

namespace alhazen::testing::ALHAZEN_TEST_FILE {
namespace {

struct Coded {
    const char* code;
    std::string text;  ///< members besides the asset; a whole file if it begins with { or a mark
};

const std::string kByteOrderMark = "\xEF\xBB\xBF";

std::string whole(const Coded& coded) {
    const bool is_whole = coded.text.starts_with('{') || coded.text.starts_with(kByteOrderMark);
    return is_whole ? coded.text : gltf_with(json(coded.text));
}

const std::string kBounds = bounds("0, 0, 0", "1, 1, 0");

/// A triangle with positions at accessor 0; `add` appends accessors from 1 on.
template <std::invocable<GltfText&> Add>
std::string triangle(const std::string& primitive, Add&& add, const std::string& rest = "") {
    GltfText text;
    text.floats("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0}, kBounds);
    add(text);
    return text.file(json("'meshes': [{'primitives': [{'attributes': {'POSITION': 0" + primitive +
                          "}]}]" + rest));
}
std::string triangle(const std::string& primitive, const std::string& rest = "") {
    return triangle(
        primitive, [](GltfText&) {}, rest);
}

/// An animation of the translation of node 0, with times and values from `add`.
template <class Add>
std::string animation(Add&& add, const std::string& sampler = "",
                      const std::string& path = "translation",
                      const std::string& nodes = "'nodes': [{}]") {
    GltfText text;
    add(text);
    return text.file(json(nodes +
                          ", 'animations': [{'channels': [{'sampler': 0, 'target': {'node': 0, "
                          "'path': '" +
                          path + "'}}], 'samplers': [{'input': 0, 'output': 1" + sampler + "}]}]"));
}

/// A skinned triangle: joints at accessor 1, weights at 2, inverse bind matrices at 3.
std::string skinned(std::initializer_list<double> joints, std::initializer_list<double> weights,
                    const std::string& nodes, const std::string& scene = "") {
    return triangle(
        ", 'JOINTS_0': 1, 'WEIGHTS_0': 2}",
        [&](GltfText& text) {
            text.bytes("VEC4", joints);
            text.floats("VEC4", weights);
        },
        ", 'skins': [{'joints': [1]}], 'nodes': [" + nodes + "]" + scene);
}
const std::string kSkinNodes = "{'mesh': 0, 'skin': 0}, {}";

/// Buffer views and accessors over 64 bytes of zeros.
std::string over_zeros(const std::string& views, const std::string& accessors,
                       const std::string& rest = "") {
    return "'buffers': [{'byteLength': 64, 'uri': 'data:application/octet-stream;base64," +
           base64(std::string(64, '\0')) + "'}], 'bufferViews': [" + views + "], 'accessors': [" +
           accessors + "]" + rest;
}
const std::string kView = "{'buffer': 0, 'byteLength': 64}";
const std::string kVec3 =
    "{'bufferView': 0, 'componentType': 5126, 'count': 3, 'type': 'VEC3', 'min': [0, 0, 0], "
    "'max': [0, 0, 0]}";

std::vector<Coded> schema_errors() {
    return {
        {"ARRAY_LENGTH_NOT_IN_LIST", "'nodes': [{'scale': [1, 1]}]"},
        {"ARRAY_TYPE_MISMATCH", "'nodes': [{'scale': [1, 1, 'a']}]"},
        {"DUPLICATE_ELEMENTS", "'nodes': [{'children': [1, 1]}, {}]"},
        {"DUPLICATE_ELEMENTS", "'extensionsUsed': ['A_a', 'A_a']"},
        {"EMPTY_ENTITY", "'nodes': []"},
        {"EMPTY_ENTITY", triangle("}, 'targets': [{}]")},
        {"INVALID_INDEX", "'nodes': [{'children': [-1]}]"},
        {"INVALID_JSON", "{"},
        {"INVALID_JSON", kByteOrderMark + gltf_with(json("'nodes': [{}]"))},
        {"INVALID_URI", "'images': [{'uri': 'a%2'}]"},
        {"ONE_OF_MISMATCH", "'images': [{}]"},
        {"ONE_OF_MISMATCH",
         "'cameras': [{'type': 'perspective', 'perspective': {'yfov': 1, 'znear': 1}, "
         "'orthographic': {'xmag': 1, 'ymag': 1, 'znear': 0, 'zfar': 1}}]"},
        {"PATTERN_MISMATCH", json("{'asset': {'version': '2'}}")},
        {"TYPE_MISMATCH", "'nodes': [{'mesh': 'a'}]"},
        {"TYPE_MISMATCH", "'samplers': [{'name': 1}]"},
        {"TYPE_MISMATCH", json("{'asset': {'version': '2.0', 'generator': 1}}")},
        {"UNDEFINED_PROPERTY", "'bufferViews': [{'byteLength': 1}]"},
        {"UNSATISFIED_DEPENDENCY", "'nodes': [{'weights': [1]}]"},
        {"VALUE_MULTIPLE_OF",
         over_zeros("{'buffer': 0, 'byteLength': 64, 'byteStride': 6}", kVec3)},
        {"VALUE_NOT_IN_RANGE", "'materials': [{'emissiveFactor': [2, 0, 0]}]"},
        {"VALUE_NOT_IN_RANGE",
         "'extensionsUsed': ['KHR_materials_sheen'], 'materials': [{'extensions': "
         "{'KHR_materials_sheen': {'sheenColorFactor': [2, 0, 0]}}}]"},
        {"VALUE_NOT_IN_RANGE",
         "'extensionsUsed': ['KHR_lights_punctual'], 'extensions': {'KHR_lights_punctual': "
         "{'lights': [{'type': 'point', 'color': [2, 0, 0]}]}}"},
    };
}

std::vector<Coded> semantic_errors() {
    const std::string sparse =
        "{'componentType': 5126, 'count': 1, 'type': 'SCALAR', 'sparse': {'count': 2, 'indices': "
        "{'bufferView': 0, 'componentType': 5121}, 'values': {'bufferView': 0}}}";
    return {
        {"ACCESSOR_MATRIX_ALIGNMENT",
         over_zeros(kView,
                    "{'bufferView': 0, 'byteOffset': 1, 'componentType': 5121, 'count': 1, "
                    "'type': 'MAT2'}")},
        {"ACCESSOR_NORMALIZED_INVALID",
         "'accessors': [{'componentType': 5126, 'count': 1, 'type': 'SCALAR', 'normalized': "
         "true}]"},
        {"ACCESSOR_OFFSET_ALIGNMENT",
         over_zeros(kView,
                    "{'bufferView': 0, 'byteOffset': 1, 'componentType': 5123, 'count': 1, "
                    "'type': 'SCALAR'}")},
        {"ACCESSOR_SPARSE_COUNT_OUT_OF_RANGE", over_zeros(kView, sparse)},
        {"ASSET_MIN_VERSION_GREATER_THAN_VERSION",
         json("{'asset': {'version': '2.0', 'minVersion': '2.1'}}")},
        {"BUFFER_DATA_URI_MIME_TYPE_INVALID",
         "'buffers': [{'byteLength': 3, 'uri': 'data:image/png;base64,AAAA'}]"},
        {"BUFFER_VIEW_INVALID_BYTE_STRIDE",
         over_zeros("{'buffer': 0, 'byteLength': 64, 'byteStride': 4, 'target': 34963}", kVec3)},
        {"BUFFER_VIEW_TOO_BIG_BYTE_STRIDE",
         over_zeros("{'buffer': 0, 'byteLength': 8, 'byteStride': 12}", kVec3)},
        {"CAMERA_XMAG_YMAG_ZERO",
         "'cameras': [{'type': 'orthographic', 'orthographic': {'xmag': 0, 'ymag': 1, 'znear': 0, "
         "'zfar': 1}}]"},
        {"CAMERA_ZFAR_LEQUAL_ZNEAR",
         "'cameras': [{'type': 'perspective', 'perspective': {'yfov': 1, 'znear': 1, 'zfar': "
         "1}}]"},
        {"INVALID_GL_VALUE",
         "'accessors': [{'componentType': 5121, 'count': 1, 'type': 'SCALAR', 'min': [0], 'max': "
         "[256]}]"},
        {"INVALID_GL_VALUE",
         "'accessors': [{'componentType': 5126, 'count': 1, 'type': 'SCALAR', 'max': [1e39]}]"},
        {"KHR_ANIMATION_POINTER_ANIMATION_CHANNEL_TARGET_PATH",
         "'extensionsUsed': ['KHR_animation_pointer'], 'accessors': [{'componentType': 5126, "
         "'count': 1, 'type': 'SCALAR', 'min': [0], 'max': [0]}], 'animations': [{'channels': "
         "[{'sampler': 0, 'target': {'path': 'scale', 'extensions': {'KHR_animation_pointer': "
         "{'pointer': '/x'}}}}], 'samplers': [{'input': 0, 'output': 0}]}]"},
        {"KHR_LIGHTS_PUNCTUAL_LIGHT_SPOT_ANGLES",
         "'extensionsUsed': ['KHR_lights_punctual'], 'extensions': {'KHR_lights_punctual': "
         "{'lights': [{'type': 'spot', 'spot': {'innerConeAngle': 0.5, 'outerConeAngle': "
         "0.4}}]}}"},
        {"MESH_INVALID_WEIGHTS_COUNT",
         "'meshes': [{'primitives': [{'attributes': {'_A': 0}}], "
         "'weights': [1]}], 'accessors': [{'componentType': 5126, "
         "'count': 1, 'type': 'SCALAR'}]"},
        {"MESH_PRIMITIVES_UNEQUAL_TARGETS_COUNT",
         triangle("}, 'targets': [{'POSITION': 0}]}, {'attributes': {'POSITION': 0}")},
        {"MESH_PRIMITIVE_INDEXED_SEMANTIC_CONTINUITY",
         triangle(", 'TEXCOORD_1': 1}",
                  [](GltfText& text) {
                      text.floats("VEC2", {0, 0, 0, 0, 0, 0});
                  })},
        {"MESH_PRIMITIVE_INVALID_ATTRIBUTE", triangle(", 'A': 0}")},
        {"MESH_PRIMITIVE_JOINTS_WEIGHTS_MISMATCH",
         triangle(", 'WEIGHTS_0': 1}",
                  [](GltfText& text) {
                      text.floats("VEC4", {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
                  })},
        {"NODE_MATRIX_NON_TRS",
         "'nodes': [{'matrix': [1, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]}]"},
        {"NODE_MATRIX_NON_TRS",
         "'nodes': [{'matrix': [0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]}]"},
        {"NODE_MATRIX_TRS",
         "'nodes': [{'matrix': [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1], 'scale': [1, 1, "
         "1]}]"},
        {"NODE_SKIN_NO_SCENE",
         skinned({0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}, {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0},
                 kSkinNodes, ", 'scenes': [{'nodes': [0]}]")},
        {"NON_REQUIRED_EXTENSION", "'extensionsUsed': ['KHR_mesh_quantization']"},
        {"ROTATION_NON_UNIT", "'nodes': [{'rotation': [0, 0, 0, 0.9]}]"},
        {"SKIN_NO_COMMON_ROOT", "'nodes': [{}, {}], 'skins': [{'joints': [0, 1]}]"},
        {"SKIN_NO_COMMON_ROOT",
         "'nodes': [{}, {}], 'skins': [{'joints': [0, 1]}], 'scenes': [{'nodes': [0, 1]}]"},
        {"SKIN_SKELETON_INVALID", "'nodes': [{}, {}], 'skins': [{'joints': [0], 'skeleton': 1}]"},
        {"UNKNOWN_ASSET_MAJOR_VERSION", json("{'asset': {'version': '3.0'}}")},
        {"UNUSED_EXTENSION_REQUIRED", "'extensionsRequired': ['KHR_materials_unlit']"},
    };
}

std::vector<Coded> link_errors() {
    const auto times_and_values = [](GltfText& text) {
        text.floats("SCALAR", {0, 1});
        text.floats("VEC3", {0, 0, 0, 1, 1, 1});
    };
    const std::string two_views = kView + ", " + kView;
    const std::string matrices =
        "{'bufferView': 0, 'componentType': 5126, 'count': 1, 'type': 'MAT4'}";
    const std::string scalars =
        "{'bufferView': 0, 'componentType': 5126, 'count': 1, 'type': "
        "'SCALAR', 'min': [0], 'max': [0]}";
    const std::string bytes =
        "{'bufferView': 0, 'componentType': 5121, 'count': 3, 'type': 'SCALAR'}";
    const std::string variants =
        "'extensionsUsed': ['KHR_materials_variants'], 'materials': [{}], 'extensions': "
        "{'KHR_materials_variants': {'variants': [{'name': 'a'}]}}, 'accessors': "
        "[{'componentType': 5126, 'count': 1, 'type': 'SCALAR'}], 'meshes': [{'primitives': "
        "[{'attributes': {'_A': 0}, 'extensions': {'KHR_materials_variants': {'mappings': ";
    return {
        {"ACCESSOR_SMALL_BYTESTRIDE",
         over_zeros("{'buffer': 0, 'byteLength': 64, 'byteStride': 8}", kVec3)},
        {"ACCESSOR_TOO_LONG", over_zeros("{'buffer': 0, 'byteLength': 32}", kVec3)},
        {"ACCESSOR_TOTAL_OFFSET_ALIGNMENT",
         over_zeros("{'buffer': 0, 'byteOffset': 2, 'byteLength': 60}", kVec3)},
        {"ACCESSOR_USAGE_OVERRIDE",
         over_zeros(kView, bytes,
                    ", 'meshes': [{'primitives': [{'attributes': {'_A': 0}, "
                    "'indices': 0}]}]")},
        {"ANIMATION_CHANNEL_TARGET_NODE_MATRIX",
         animation(times_and_values, "", "translation",
                   "'nodes': [{'matrix': [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]}]")},
        {"ANIMATION_CHANNEL_TARGET_NODE_WEIGHTS_NO_MORPHS",
         animation(times_and_values, "", "weights")},
        {"ANIMATION_DUPLICATE_TARGETS",
         animation(times_and_values, "",
                   "translation'}}, {'sampler': 0, 'target': {'node': 0, 'path': 'translation")},
        {"ANIMATION_SAMPLER_ACCESSOR_WITH_BYTESTRIDE",
         over_zeros("{'buffer': 0, 'byteLength': 32, 'byteStride': 4}, " + kView,
                    scalars + ", {'bufferView': 1, 'componentType': 5126, 'count': 1, 'type': "
                              "'VEC3'}",
                    ", 'nodes': [{}], 'animations': [{'channels': [{'sampler': 0, 'target': "
                    "{'node': 0, 'path': 'scale'}}], 'samplers': [{'input': 0, 'output': 1}]}]")},
        {"ANIMATION_SAMPLER_INPUT_ACCESSOR_INVALID_FORMAT", animation([](GltfText& text) {
             text.bytes("SCALAR", {0, 1});
             text.floats("VEC3", {0, 0, 0, 1, 1, 1});
         })},
        {"ANIMATION_SAMPLER_INPUT_ACCESSOR_TOO_FEW_ELEMENTS",
         animation(
             [](GltfText& text) {
                 text.floats("SCALAR", {0});
                 text.floats("VEC3", {0, 0, 0, 1, 1, 1, 0, 0, 0});
             },
             ", 'interpolation': 'CUBICSPLINE'")},
        {"ANIMATION_SAMPLER_INPUT_ACCESSOR_WITHOUT_BOUNDS", animation([](GltfText& text) {
             text.floats("SCALAR", {0, 1}, " ");
             text.floats("VEC3", {0, 0, 0, 1, 1, 1});
         })},
        {"ANIMATION_SAMPLER_OUTPUT_ACCESSOR_INVALID_COUNT", animation([](GltfText& text) {
             text.floats("SCALAR", {0, 1});
             text.floats("VEC3", {0, 0, 0});
         })},
        {"ANIMATION_SAMPLER_OUTPUT_ACCESSOR_INVALID_FORMAT",
         animation(times_and_values, "", "rotation")},
        {"BUFFER_VIEW_TARGET_OVERRIDE",
         over_zeros("{'buffer': 0, 'byteLength': 64, 'target': 34963}", kVec3,
                    ", 'meshes': [{'primitives': [{'attributes': {'POSITION': 0}}]}]")},
        {"BUFFER_VIEW_TARGET_OVERRIDE",
         over_zeros(kView, kVec3 + ", " + bytes,
                    ", 'meshes': [{'primitives': [{'attributes': {'POSITION': 0}, 'indices': "
                    "1}]}]")},
        {"BUFFER_VIEW_TOO_LONG", over_zeros("{'buffer': 0, 'byteLength': 65}", kVec3)},
        {"IMAGE_BUFFER_VIEW_WITH_BYTESTRIDE",
         over_zeros("{'buffer': 0, 'byteLength': 64, 'byteStride': 4}, " + kView,
                    "{'bufferView': 1, 'componentType': 5121, 'count': 1, 'type': 'SCALAR'}",
                    ", 'images': [{'bufferView': 0, 'mimeType': 'image/png'}]")},
        {"INVALID_IBM_ACCESSOR_COUNT",
         over_zeros(kView, matrices,
                    ", 'nodes': [{'children': [1]}, {}], 'skins': [{'joints': [0, 1], "
                    "'inverseBindMatrices': 0}]")},
        {"KHR_MATERIALS_VARIANTS_NON_UNIQUE_VARIANT",
         variants + "[{'material': 0, 'variants': [0]}, {'material': 0, 'variants': [0]}]}}}]}]"},
        {"EMPTY_ENTITY", variants + "[]}}}]}]"},
        {"MESH_PRIMITIVE_ACCESSOR_UNALIGNED",
         over_zeros("{'buffer': 0, 'byteLength': 64}",
                    "{'bufferView': 0, 'byteOffset': 1, 'componentType': 5121, 'count': 1, "
                    "'type': 'VEC4'}",
                    ", 'meshes': [{'primitives': [{'attributes': {'_A': 0}}]}]")},
        {"MESH_PRIMITIVE_ACCESSOR_WITHOUT_BYTESTRIDE",
         over_zeros(kView, kVec3 + ", " + kVec3,
                    ", 'meshes': [{'primitives': [{'attributes': {'POSITION': 0, '_A': 1}}]}]")},
        {"MESH_PRIMITIVE_ATTRIBUTES_ACCESSOR_INVALID_FORMAT", triangle(", 'TEXCOORD_0': 0}")},
        {"MESH_PRIMITIVE_ATTRIBUTES_ACCESSOR_UNSIGNED_INT",
         over_zeros(kView, "{'bufferView': 0, 'componentType': 5125, 'count': 1, 'type': 'SCALAR'}",
                    ", 'meshes': [{'primitives': [{'attributes': {'_A': 0}}]}]")},
        {"MESH_PRIMITIVE_INDICES_ACCESSOR_INVALID_FORMAT",
         triangle("}, 'indices': 1",
                  [](GltfText& text) {
                      text.floats("SCALAR", {0, 1, 2});
                  })},
        {"MESH_PRIMITIVE_INDICES_ACCESSOR_WITH_BYTESTRIDE",
         over_zeros("{'buffer': 0, 'byteLength': 36}, {'buffer': 0, 'byteLength': 12, "
                    "'byteStride': 4}",
                    kVec3 + ", {'bufferView': 1, 'componentType': 5121, 'count': 3, 'type': "
                            "'SCALAR'}",
                    ", 'meshes': [{'primitives': [{'attributes': {'POSITION': 0}, 'indices': "
                    "1}]}]")},
        {"MESH_PRIMITIVE_MORPH_TARGET_INVALID_ATTRIBUTE_COUNT",
         triangle("}, 'targets': [{'POSITION': 1}]",
                  [](GltfText& text) {
                      text.floats("VEC3", {0, 0, 0}, bounds("0, 0, 0", "0, 0, 0"));
                  })},
        {"MESH_PRIMITIVE_MORPH_TARGET_NO_BASE_ACCESSOR", triangle("}, 'targets': [{'NORMAL': 0}]")},
        {"MESH_PRIMITIVE_POSITION_ACCESSOR_WITHOUT_BOUNDS",
         "'accessors': [{'componentType': 5126, 'count': 3, 'type': 'VEC3'}], 'meshes': "
         "[{'primitives': [{'attributes': {'POSITION': 0}}]}]"},
        {"MESH_PRIMITIVE_TOO_FEW_TEXCOORDS",
         triangle("}, 'material': 0",
                  ", 'textures': [{}], 'materials': [{'normalTexture': "
                  "{'index': 0}}]")},
        {"MESH_PRIMITIVE_TOO_FEW_TEXCOORDS",
         triangle("}, 'material': 0",
                  ", 'textures': [{}], 'extensionsUsed': ['KHR_materials_sheen'], 'materials': "
                  "[{'extensions': {'KHR_materials_sheen': {'sheenColorTexture': {'index': "
                  "0}}}}]")},
        {"MESH_PRIMITIVE_UNEQUAL_ACCESSOR_COUNT", triangle(", '_A': 1}",
                                                           [](GltfText& text) {
                                                               text.floats("SCALAR", {0, 1});
                                                           })},
        {"NODE_LOOP", "'nodes': [{'children': [0]}]"},
        {"NODE_PARENT_OVERRIDE", "'nodes': [{'children': [2]}, {'children': [2]}, {}]"},
        {"NODE_SKIN_WITH_NON_SKINNED_MESH",
         triangle("}", ", 'skins': [{'joints': [0]}], 'nodes': [{'mesh': 0, 'skin': 0}]")},
        {"NODE_WEIGHTS_INVALID", triangle("}", ", 'nodes': [{'mesh': 0, 'weights': [1]}]")},
        {"SCENE_NON_ROOT_NODE", "'nodes': [{'children': [1]}, {}], 'scenes': [{'nodes': [1]}]"},
        {"SKIN_IBM_ACCESSOR_WITH_BYTESTRIDE",
         over_zeros("{'buffer': 0, 'byteLength': 64, 'byteStride': 64}", matrices,
                    ", 'nodes': [{}], 'skins': [{'joints': [0], 'inverseBindMatrices': 0}]")},
        {"SKIN_IBM_INVALID_FORMAT",
         over_zeros(kView, scalars,
                    ", 'nodes': [{}], 'skins': [{'joints': [0], 'inverseBindMatrices': 0}]")},
        {"TEXTURE_INVALID_IMAGE_MIME_TYPE",
         "'extensionsUsed': ['EXT_texture_webp'], 'images': [{'uri': "
         "'data:image/webp;base64,UklGRgAAAABXRUJQ'}], 'textures': [{'source': 0}]"},
        {"UNDECLARED_EXTENSION", "'materials': [{'extensions': {'KHR_materials_unlit': {}}}]"},
        {"UNEXPECTED_EXTENSION_OBJECT",
         "'extensionsUsed': ['KHR_texture_transform'], 'nodes': [{'extensions': "
         "{'KHR_texture_transform': {}}}]"},
        {"UNRESOLVED_REFERENCE", "'nodes': [{'mesh': 0}]"},
    };
}

std::vector<Coded> data_errors() {
    const auto one_matrix = [](double last) {
        GltfText text;
        text.floats("MAT4", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, last});
        return text.file(
            json("'nodes': [{}], 'skins': [{'joints': [0], 'inverseBindMatrices': 0}]"));
    };
    const auto times = [](double first, double second) {
        return animation([=](GltfText& text) {
            text.floats("SCALAR", {first, second});
            text.floats("VEC3", {0, 0, 0, 1, 1, 1});
        });
    };
    const auto scalars = [](std::initializer_list<double> numbers, const std::string& more) {
        GltfText text;
        text.floats("SCALAR", numbers, more);
        return text.file(json("'nodes': [{}]"));
    };
    const auto indexed = [](std::initializer_list<double> indices) {
        return triangle("}, 'indices': 1", [&](GltfText& text) { text.bytes("SCALAR", indices); });
    };
    const auto sparse = [](const std::string& indices) {
        GltfText text;
        text.bytes("SCALAR", {0, 0, 1, 1, 7});
        const std::string file = text.file(json("'nodes': [{}]"));
        const std::string more = json(
            ", {'componentType': 5121, 'count': 4, 'type': 'SCALAR', 'sparse': {'count': 2, "
            "'indices': {'bufferView': 0, 'componentType': 5121, 'byteOffset': " +
            indices + "}, 'values': {'bufferView': 0}}}");
        const std::size_t at = file.find("], \"bufferViews\"");
        return file.substr(0, at) + more + file.substr(at);
    };
    const auto png = [](const std::string& header) {
        return "\x89PNG\r\n\x1a\n" + std::string("\0\0\0\x0d", 4) + "IHDR" + header + "cccc";
    };
    const std::initializer_list<double> first_joint = {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0};
    return {
        {"ACCESSOR_ANIMATION_INPUT_NEGATIVE", times(-1, 1)},
        {"ACCESSOR_ANIMATION_INPUT_NON_INCREASING", times(1, 1)},
        {"ACCESSOR_ANIMATION_SAMPLER_OUTPUT_NON_NORMALIZED_QUATERNION",
         animation(
             [](GltfText& text) {
                 text.floats("SCALAR", {0, 1});
                 text.floats("VEC4", {0, 0, 0, 1, 0, 0, 0, 0.9});
             },
             "", "rotation")},
        {"ACCESSOR_MAX_MISMATCH", scalars({1, 2}, bounds("1", "3"))},
        {"ACCESSOR_MIN_MISMATCH", scalars({1, 2}, bounds("0", "2"))},
        {"ACCESSOR_ELEMENT_OUT_OF_MAX_BOUND", scalars({1, 2}, bounds("1", "1.5"))},
        {"ACCESSOR_ELEMENT_OUT_OF_MIN_BOUND", scalars({1, 2}, bounds("1.5", "2"))},
        {"ACCESSOR_INDEX_OOB", indexed({0, 1, 3})},
        {"ACCESSOR_INDEX_PRIMITIVE_RESTART", indexed({0, 1, 255})},
        {"ACCESSOR_INVALID_FLOAT", scalars({1, std::numeric_limits<double>::infinity()}, " ")},
        {"ACCESSOR_INVALID_IBM", one_matrix(2)},
        {"ACCESSOR_INVALID_SIGN",
         triangle(", 'NORMAL': 1, 'TANGENT': 2}",
                  [](GltfText& text) {
                      text.floats("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1});
                      text.floats("VEC4", {1, 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1});
                  })},
        {"ACCESSOR_JOINTS_INDEX_DUPLICATE",
         skinned(first_joint, {0.5, 0.5, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, kSkinNodes)},
        {"ACCESSOR_JOINTS_INDEX_OOB", skinned({1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0},
                                              {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, kSkinNodes)},
        {"ACCESSOR_NON_CLAMPED", triangle(", 'COLOR_0': 1}",
                                          [](GltfText& text) {
                                              text.floats("VEC3", {0, 0, 2, 0, 0, 1, 0, 0, 1});
                                          })},
        {"ACCESSOR_SPARSE_INDEX_OOB", sparse("3")},
        {"ACCESSOR_SPARSE_INDICES_NON_INCREASING", sparse("0")},
        {"ACCESSOR_WEIGHTS_NEGATIVE",
         skinned({0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}, {1.5, -0.5, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0},
                 kSkinNodes)},
        {"ACCESSOR_WEIGHTS_NON_NORMALIZED",
         skinned(first_joint, {0.5, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, kSkinNodes)},
        {"BUFFER_BYTE_LENGTH_MISMATCH",
         "'buffers': [{'byteLength': 4, 'uri': 'data:application/octet-stream;base64,AAAA'}]"},
        {"IMAGE_DATA_INVALID", "'images': [{'uri': 'data:image/jpeg;base64,/9j/AAAA'}]"},
        {"IMAGE_MIME_TYPE_INVALID", "'images': [{'uri': 'data:image/png;base64,/9j/4A=='}]"},
        {"IMAGE_NON_ENABLED_MIME_TYPE",
         "'images': [{'uri': 'data:image/webp;base64,UklGRgAAAABXRUJQ'}]"},
        {"IMAGE_UNEXPECTED_EOS", "'images': [{'uri': 'data:image/jpeg;base64,/9j/4A=='}]"},
        {"IMAGE_UNEXPECTED_EOS",
         "'images': [{'uri': 'data:image/png;base64," +
             base64(png(std::string("\0\0\0\x01\0\0\0\x01\x08\0\0\0\0", 13))) + "'}]"},
        {"IO_ERROR", "'images': [{'uri': 'nothing.png'}]"},
    };
}

class GltfValidatorCodes : public ::testing::TestWithParam<std::vector<Coded> (*)()> {};

TEST_P(GltfValidatorCodes, AreRefused) {
    for (const Coded& coded : GetParam()()) {
        const auto read = read_gltf(whole(coded));
        EXPECT_FALSE(read.is_good()) << coded.code << "\n" << read.findings() << coded.text;
    }
}

INSTANTIATE_TEST_SUITE_P(Schema, GltfValidatorCodes, ::testing::Values(&schema_errors));
INSTANTIATE_TEST_SUITE_P(Semantic, GltfValidatorCodes, ::testing::Values(&semantic_errors));
INSTANTIATE_TEST_SUITE_P(Link, GltfValidatorCodes, ::testing::Values(&link_errors));
INSTANTIATE_TEST_SUITE_P(Data, GltfValidatorCodes, ::testing::Values(&data_errors));

/// The templates above are sound: without their faults the files are read.
TEST(GltfValidatorTemplates, AreRead) {
    const std::string files[] = {
        triangle("}"),
        animation([](GltfText& text) {
            text.floats("SCALAR", {0, 1});
            text.floats("VEC3", {0, 0, 0, 1, 1, 1});
        }),
        skinned({0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}, {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0},
                kSkinNodes, ", 'scenes': [{'nodes': [0, 1]}]"),
        gltf_with(json(over_zeros(kView, kVec3))),
    };
    for (const std::string& file : files) {
        const auto read = read_gltf(file);
        EXPECT_TRUE(read.is_good()) << read.findings() << file;
    }
}

TEST(GltfValidatorMilder, OnlyTheLookOrRoundingIsLost) {
    const auto weights = [](double first) {
        return skinned({0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0},
                       {first, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, kSkinNodes,
                       ", 'scenes': [{'nodes': [0, 1]}]");
    };
    for (const Coded& coded : {
             Coded{"ACCESSOR_WEIGHTS_NON_NORMALIZED", weights(0.995)},
             Coded{"ACCESSOR_VECTOR3_NON_UNIT",
                   triangle(", 'NORMAL': 1}",
                            [](GltfText& text) {
                                text.floats("VEC3", {0, 0, 2, 0, 0, 1, 0, 0, 1});
                            })},
             Coded{"MESH_PRIMITIVE_NO_TANGENT_SPACE",
                   triangle("}, 'material': 0",
                            ", 'extensionsUsed': "
                            "['KHR_materials_anisotropy'], 'materials': "
                            "[{'extensions': {'KHR_materials_anisotropy': "
                            "{'anisotropyStrength': 1}}}]")},
         }) {
        const auto read = read_gltf(coded.text);
        EXPECT_TRUE(read.is_good()) << coded.code << "\n" << read.findings();
        EXPECT_GT(read.diagnostics.warning_count(), 0u) << coded.code;
    }
}

}  // namespace
}  // namespace alhazen::testing::ALHAZEN_TEST_FILE
