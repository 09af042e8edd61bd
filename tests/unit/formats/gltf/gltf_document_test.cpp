#include <gtest/gtest.h>

#include "alhazen/formats/gltf/document/gltf_uri.h"
#include "unit/formats/gltf/gltf_read.h"

namespace alhazen::testing::ALHAZEN_TEST_FILE {
namespace {

std::string word(std::uint32_t value) {
    std::string bytes;
    for (int i = 0; i < 4; ++i) bytes += static_cast<char>(value >> (8 * i) & 0xFF);
    return bytes;
}
std::string chunk(const char* type, std::string content, char padding) {
    while (content.size() % 4 != 0) content += padding;
    return word(static_cast<std::uint32_t>(content.size())) + std::string(type, 4) + content;
}
std::string glb_of(const std::string& chunks) {
    return "glTF" + word(2) + word(static_cast<std::uint32_t>(12 + chunks.size())) + chunks;
}
const std::string kGlbJson = gltf_with(
    json("'buffers': [{'byteLength': 5}], 'bufferViews': [{'buffer': 0, 'byteLength': 5}], "
         "'accessors': [{'bufferView': 0, 'componentType': 5121, 'count': 5, 'type': 'SCALAR'}]"));

TEST(GltfContainer, TheBinaryChunkIsTheFirstBufferWithoutItsPadding) {
    const auto read = read_gltf(
        glb_of(chunk("JSON", kGlbJson, ' ') + chunk("BIN\0", std::string("\1\2\3\4\5"), '\0')));
    ASSERT_TRUE(read.is_good()) << read.findings();
    EXPECT_EQ(read.document.buffers.at(0).bytes, "\1\2\3\4\5");
    EXPECT_EQ(gltf::read_integers(read.document, 0), (std::vector<std::uint32_t>{1, 2, 3, 4, 5}));
}

TEST(GltfContainer, UnknownChunksAreSkipped) {
    const auto read = read_gltf(glb_of(chunk("JSON", kGlbJson, ' ') +
                                       chunk("BIN\0", std::string("\1\2\3\4\5"), '\0') +
                                       chunk("MINE", "anything", ' ')));
    EXPECT_TRUE(read.is_good()) << read.findings();
}

TEST(GltfContainer, EveryCutIsRefused) {
    const std::string whole = glb_of(chunk("JSON", kGlbJson, ' ') + chunk("BIN\0", "12345", '\0'));
    for (std::size_t size = 4; size < whole.size(); ++size) {
        EXPECT_TRUE(read_gltf(whole.substr(0, size)).says("GLB: ")) << size;
    }
}

TEST(GltfContainer, ShortBinaryChunksAreRefused) {
    const auto read =
        read_gltf(glb_of(chunk("JSON", kGlbJson, ' ') + chunk("BIN\0", "1234", '\0')));
    EXPECT_TRUE(read.says("#/buffers/0/byteLength: expected 5 bytes, found 4")) << read.findings();
}

TEST(GltfContainer, FaultyChunksAreRefused) {
    const std::string text = chunk("JSON", kGlbJson, ' ');
    const std::string binary = chunk("BIN\0", "12345", '\0');
    const std::string whole = glb_of(text + binary);
    ASSERT_TRUE(read_gltf(whole).is_good());
    struct Fault {
        std::string bytes;
        const char* finding;
    };
    const Fault faults[] = {
        {"glTF" + word(1) + whole.substr(8), "GLB: expected version 2, found 1"},
        {"glTF" + word(2) + word(8) + whole.substr(12), "GLB: the header gives a length of 8"},
        {whole + "1234", "GLB: the header gives a length of"},
        {glb_of(word(2) + "JSON{}"), "GLB: the length of chunk 0 is not a multiple of 4"},
        {glb_of(word(400) + "JSON{}  "), "GLB: chunk 0 has 400 bytes"},
        {glb_of(binary + text), "GLB: the first chunk is not the JSON chunk"},
        {glb_of(text + text), "GLB: chunk 1 is a second JSON chunk"},
        {glb_of(text + binary + binary), "GLB: chunk 2 is a second binary chunk"},
        {glb_of(text + chunk("MINE", "any", ' ') + binary),
         "GLB: the binary chunk is not the second one"},
        {glb_of(chunk("JSON", "", ' ')), "GLB: the JSON chunk is empty"},
        {"GLTF" + whole.substr(4), "JSON: "},
    };
    for (const auto& [bytes, finding] : faults) {
        const auto read = read_gltf(bytes);
        EXPECT_TRUE(read.says(finding)) << finding << "\n" << read.findings();
        EXPECT_FALSE(read.is_good()) << finding;
    }
}

TEST(GltfUri, Base64IsDecodedToItsLastByte) {
    EXPECT_EQ(gltf::base64_decoded("").value(), "");
    EXPECT_EQ(gltf::base64_decoded("Zg==").value(), "f");
    EXPECT_EQ(gltf::base64_decoded("Zm8=").value(), "fo");
    EXPECT_EQ(gltf::base64_decoded("Zm9v").value(), "foo");
    EXPECT_EQ(gltf::base64_decoded("Zm9vYg").value(), "foob");
    for (const char* bad : {"Z", "Zg=", "Z===", "Zm9v!", "Zm 9v", "=", "Zg==Zg=="}) {
        EXPECT_FALSE(gltf::base64_decoded(bad)) << bad;
    }
}

TEST(GltfUri, PercentSignsStandForBytes) {
    EXPECT_EQ(gltf::percent_decoded("a%20b%2f").value(), "a b/");
    EXPECT_FALSE(gltf::percent_decoded("a%2"));
    EXPECT_FALSE(gltf::percent_decoded("a%zz"));
}

TEST(GltfUri, SchemesAreNoFileNames) {
    EXPECT_TRUE(gltf::is_absolute_uri("http://x/y.bin"));
    EXPECT_TRUE(gltf::is_absolute_uri("/etc/passwd"));
    EXPECT_FALSE(gltf::is_absolute_uri("folder/a:b.bin"));
    EXPECT_FALSE(gltf::is_absolute_uri("a.bin"));
}

TEST(GltfExtensions, AllThatAreMissingAreNamedInOneErrorAndNothingElse) {
    const auto read = read_gltf(
        json("{'asset': {}, 'extensionsUsed': ['A_a', 'B_b', 'KHR_texture_transform'], "
             "'extensionsRequired': ['A_a', 'KHR_texture_transform', 'B_b'], 'meshes': 3}"));
    ASSERT_EQ(read.diagnostics.all().size(), 1u) << read.findings();
    EXPECT_TRUE(read.says("requires extensions that are not supported: A_a, B_b"));
}

TEST(GltfExtensions, OnesThatAreOnlyUsedAreWarnings) {
    const auto read = read_gltf(gltf_with(json("'extensionsUsed': ['A_a', 'KHR_materials_ior']")));
    EXPECT_TRUE(read.is_good()) << read.findings();
    EXPECT_EQ(read.diagnostics.warning_count(), 1u);
    EXPECT_TRUE(read.says("the extension A_a is not supported; ignored"));
}

TEST(GltfExtensions, OfTheLookAreWarningsEvenWhereTheyAreRequired) {
    const auto read = read_gltf(
        gltf_with(json("'extensionsUsed': ['KHR_materials_unheard_of'], 'extensionsRequired': "
                       "['KHR_materials_unheard_of']")));
    EXPECT_TRUE(read.is_good()) << read.findings();
    EXPECT_EQ(read.diagnostics.warning_count(), 1u) << read.findings();
    EXPECT_TRUE(read.says("KHR_materials_unheard_of is not supported; it is left out of the"));
}

TEST(GltfDocument, UnknownValuesThatLeaveThePictureAreWarnings) {
    for (const char* members :
         {"'cameras': [{'type': 'perspective', 'perspective': {'yfov': 4, 'znear': 1}}]",
          "'cameras': [{'type': 'fisheye'}]",
          "'extensionsUsed': ['KHR_lights_punctual'], 'extensions': {'KHR_lights_punctual': "
          "{'lights': [{'type': 'area'}]}}",
          "'accessors': [{'componentType': 5126, 'count': 1, 'type': 'SCALAR'}], 'meshes': "
          "[{'primitives': [{'mode': 7, 'attributes': {'_A': 0}}]}]",
          "'accessors': [{'componentType': 5124, 'count': 1, 'type': 'SCALAR'}]",
          "'accessors': [{'componentType': 5126, 'count': 1, 'type': 'VEC5'}]"}) {
        const auto read = read_gltf(gltf_with(json(members)));
        EXPECT_TRUE(read.is_good()) << read.findings();
        EXPECT_GE(read.diagnostics.warning_count(), 1u) << read.findings();
    }
    const auto later = read_gltf(json("{'asset': {'version': '2.1', 'minVersion': '2.1'}}"));
    EXPECT_TRUE(later.is_good()) << later.findings();
    EXPECT_TRUE(later.says("#/asset/minVersion: a later version is required; read as 2.0"));
    const auto newer = read_gltf(json("{'asset': {'version': '2.1'}}"));
    EXPECT_TRUE(newer.is_good()) << newer.findings();
    EXPECT_TRUE(newer.says("#/asset/version: later than 2.0; read as 2.0")) << newer.findings();
}

TEST(GltfDocument, DataUrisOfBuffersNameBytes) {
    const auto file = [](const char* head) {
        return read_gltf(gltf_with(
            json("'buffers': [{'byteLength': 3, 'uri': 'data:" + std::string(head) + "'}]")));
    };
    for (const char* good :
         {"application/octet-stream;base64,AAAA", "application/gltf-buffer;base64,AAAA",
          "application/gltf-buffer,abc", "application/octet-stream,%00a%01"}) {
        EXPECT_TRUE(file(good).is_good()) << good << file(good).findings();
    }
    for (const char* bad : {";base64,AAAA", "text/plain;base64,AAAA", "image/png;base64,AAAA"}) {
        EXPECT_TRUE(file(bad).says("#/buffers/0/uri: the media type of a data: URI must be"))
            << bad;
    }
}

TEST(GltfDocument, BuffersWithoutDataHoldZerosButNotInAGlb) {
    const std::string text = gltf_with(
        json("'buffers': [{'byteLength': 36}], 'bufferViews': [{'buffer': 0, 'byteLength': 36}], "
             "'accessors': [{'bufferView': 0, 'componentType': 5126, 'count': 3, 'type': 'VEC3', "
             "'min': [0, 0, 0], 'max': [1, 1, 0]}]"));
    const auto read = read_gltf(text);
    EXPECT_TRUE(read.is_good()) << read.findings();
    EXPECT_TRUE(read.says("#/buffers/0: the buffer has no data; numbers in it are taken as 0"));
    EXPECT_EQ(gltf::read_numbers(read.document, 0), std::vector<double>(9, 0.0));
    EXPECT_TRUE(read_gltf(glb_of(chunk("JSON", text, ' ')))
                    .says("#/buffers/0: the buffer has no uri and the file no binary chunk"));
}

struct Refusal {
    const char* name;
    const char* text;     ///< members in addition to the asset; a whole file if it begins with {
    const char* finding;  ///< part of the message
};

class GltfRefusal : public ::testing::TestWithParam<Refusal> {};

TEST_P(GltfRefusal, NamesThePlace) {
    const std::string text = json(GetParam().text);
    const auto read = read_gltf(text.starts_with('{') ? text : gltf_with(text));
    EXPECT_FALSE(read.is_good());
    EXPECT_TRUE(read.says(GetParam().finding)) << read.findings();
}

/// Three vertices with positions, at accessor 0, and one more faulty member.
#define TRIANGLE                                                                           \
    "'buffers': [{'byteLength': 36, 'uri': 'data:application/octet-stream;base64,AAAAAAAA" \
    "AAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA'}], 'bufferViews': [{'buffer': 0, 'byteLeng" \
    "th': 36}, {'buffer': 0, 'byteLength': 36}], 'accessors': [{'bufferView': 0, 'compone" \
    "ntType': 5126, 'count': 3, 'type': 'VEC3', 'min': [0, 0, 0], 'max': [1, 1, 0]}, {'bu" \
    "fferView': 1, 'componentType': 5121, 'count': 3, 'type': 'SCALAR'}, {'bufferView': 1" \
    ", 'byteOffset': 14, 'componentType': 5121, 'count': 3, 'type': 'SCALAR'}]"

INSTANTIATE_TEST_SUITE_P(
    Json, GltfRefusal,
    ::testing::Values(
        Refusal{"Syntax", "{'asset':\n  {'version' '2.0'}}", "scene.gltf:2:"},
        Refusal{"DuplicateKeys", "{'asset': {'version': '2.0', 'version': '2.0'}}",
                "#: the key \"version\" occurs twice"},
        Refusal{"NoObject", "{'asset': []}", "#/asset: expected an object, found an array"},
        Refusal{"HugeNumber", "'nodes': [{'scale': [1, 1, 1e999]}]", "JSON: "},
        Refusal{"NoAsset", "{}", "#: \"asset\" is missing"},
        Refusal{"Version1", "{'asset': {'version': '1.0'}}",
                "#/asset/version: only glTF 2.0 is supported"},
        Refusal{"MinVersion", "{'asset': {'version': '2.0', 'minVersion': '2.1'}}",
                "#/asset/minVersion"},
        Refusal{"EmptyArray", "'nodes': []", "#/nodes: the array must not be empty"},
        Refusal{"WrongElement", "'nodes': [{}, 1]", "#/nodes/1: expected an object, found number"},
        Refusal{"MisplacedExtension",
                "'extensionsUsed': ['KHR_materials_unlit'], 'nodes': [{'extensions': "
                "{'KHR_materials_unlit': {}}}]",
                "#/nodes/0/extensions/KHR_materials_unlit: the extension does not belong"},
        Refusal{"UndeclaredExtension", "'extensions': {'A_a': {}}",
                "#/extensions/A_a: the extension is not listed"}),
    [](const auto& test) { return std::string(test.param.name); });

INSTANTIATE_TEST_SUITE_P(
    Objects, GltfRefusal,
    ::testing::Values(
        Refusal{"NoSuchChild", "'nodes': [{'children': [1]}]",
                "#/nodes/0/children/0: there is no node 1 (the file has 1)"},
        Refusal{"Loop", "'nodes': [{'children': [1]}, {'children': [0]}]",
                "#/nodes/1: the node is"},
        Refusal{"TwoParents", "'nodes': [{'children': [2]}, {'children': [2]}, {}]",
                "#/nodes/1: node 2 is a child of node 0 already"},
        Refusal{"SceneOfAChild", "'nodes': [{'children': [1]}, {}], 'scenes': [{'nodes': [1]}]",
                "#/scenes/0: node 1"},
        Refusal{"MatrixAndScale",
                "'nodes': [{'matrix': [1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1], 'scale': [1,1,1]}]",
                "#/nodes/0/scale"},
        Refusal{"NoRotation", "'nodes': [{'rotation': [0, 0, 0, 0]}]", "#/nodes/0/rotation"},
        Refusal{"SkinWithoutMesh", "'nodes': [{'skin': 0}], 'skins': [{'joints': [0]}]",
                "#/nodes/0/skin: not allowed without a mesh"},
        Refusal{"JointsApart", "'nodes': [{}, {}], 'skins': [{'joints': [0, 1]}]",
                "#/skins/0/joints: the joints have no common root"},
        Refusal{
            "Roughness", "'materials': [{'pbrMetallicRoughness': {'roughnessFactor': 1.5}}]",
            "#/materials/0/pbrMetallicRoughness/roughnessFactor: expected a number from 0 to 1"},
        Refusal{"NoSuchTexture", "'materials': [{'normalTexture': {'index': 0}}]",
                "#/materials/0/normalTexture/index: there is no texture 0"},
        Refusal{"FieldOfView",
                "'cameras': [{'type': 'perspective', 'perspective': {'yfov': 0, 'znear': 1}}]",
                "#/cameras/0/perspective/yfov: expected a number above 0, found 0"},
        Refusal{"SpotAngles",
                "'extensionsUsed': ['KHR_lights_punctual'], 'extensions': "
                "{'KHR_lights_punctual': {'lights': [{'type': 'spot', 'spot': {'innerConeAngle': "
                "0.5, 'outerConeAngle': 0.4}}]}}",
                "#/extensions/KHR_lights_punctual/lights/0/spot/outerConeAngle"},
        Refusal{"FileOutside", "'buffers': [{'byteLength': 1, 'uri': '../../x.bin'}]",
                "#/buffers/0/uri: the file name"},
        Refusal{"FileOutsideInPercents", "'buffers': [{'byteLength': 1, 'uri': '%2e%2e/x.bin'}]",
                "#/buffers/0/uri: the file name"},
        Refusal{
            "BufferTooShort",
            "'buffers': [{'byteLength': 3, 'uri': 'data:application/octet-stream;base64,AAA='}]",
            "#/buffers/0/byteLength: expected 3 bytes, found 2"},
        Refusal{"ImageOutside", "'images': [{'uri': '/etc/passwd'}]", "#/images/0/uri"}),
    [](const auto& test) { return std::string(test.param.name); });

INSTANTIATE_TEST_SUITE_P(
    Meshes, GltfRefusal,
    ::testing::Values(
        Refusal{"IndexBeyondVertices",
                TRIANGLE ", 'meshes': [{'primitives': [{'attributes': {'POSITION': 0}, "
                         "'indices': 2}]}]",
                "#/meshes/0/primitives/0/indices: index 128 is beyond the 3 vertices"},
        Refusal{"PositionsAsIndices",
                TRIANGLE ", 'meshes': [{'primitives': [{'attributes': {'POSITION': 0}, "
                         "'indices': 0}]}]",
                "#/meshes/0/primitives/0/indices: indices must be SCALAR"},
        Refusal{"WrongFormat",
                TRIANGLE ", 'meshes': [{'primitives': [{'attributes': {'TEXCOORD_0': 0}}]}]",
                "an accessor with VEC3 of FLOAT is not allowed here"},
        Refusal{"UnknownAttribute",
                TRIANGLE ", 'meshes': [{'primitives': [{'attributes': {'TEXCOORD_00': 0}}]}]",
                "TEXCOORD_00: there is no attribute of this name"},
        Refusal{"NoSuchAccessor",
                TRIANGLE ", 'meshes': [{'primitives': [{'attributes': {'NORMAL': 3}}]}]",
                "#/meshes/0/primitives/0/attributes/NORMAL: there is no accessor 3"},
        Refusal{"TargetWithoutBase",
                TRIANGLE ", 'meshes': [{'primitives': [{'attributes': {'POSITION': 0}, "
                         "'targets': [{'NORMAL': 0}]}]}]",
                "#/meshes/0/primitives/0/targets/0/NORMAL: the primitive has no such attribute"},
        Refusal{"WeightsOfNoTarget",
                TRIANGLE ", 'meshes': [{'primitives': [{'attributes': {'POSITION': 0}}], "
                         "'weights': [1]}]",
                "#/meshes/0: 1 weights for 0 morph targets"},
        Refusal{"NoTextureCoordinates",
                TRIANGLE ", 'images': [{'uri': 'data:image/x;base64,AAAA'}], 'textures': "
                         "[{'source': 0}], 'materials': [{'normalTexture': {'index': 0}}], "
                         "'meshes': [{'primitives': [{'attributes': {'POSITION': 0}, 'material': "
                         "0}]}]",
                "#/meshes/0/primitives/0/material: a texture of material 0 needs the attribute "
                "TEXCOORD_0"}),
    [](const auto& test) { return std::string(test.param.name); });

TEST(GltfDocument, BytesAsPositionsNeedTheExtensionForThem) {
    const std::string rest =
        "'buffers': [{'byteLength': 4, 'uri': 'data:application/octet-stream;base64,AAAAAA=='}], "
        "'bufferViews': "
        "[{'buffer': 0, 'byteLength': 4, 'byteStride': 4}], 'accessors': [{'bufferView': 0, "
        "'componentType': 5120, 'count': 1, 'type': 'VEC3', 'min': [0, 0, 0], 'max': [0, 0, 0]}], "
        "'meshes': [{'primitives': [{'mode': 0, 'attributes': {'POSITION': 0}}]}]";
    EXPECT_TRUE(read_gltf(gltf_with(json(rest))).says("VEC3 of BYTE is not allowed here"));
    const auto read =
        read_gltf(gltf_with(json("'extensionsUsed': ['KHR_mesh_quantization'], "
                                 "'extensionsRequired': ['KHR_mesh_quantization'], " +
                                 rest)));
    EXPECT_TRUE(read.is_good()) << read.findings();
}

TEST(GltfDocument, DepthOfJsonIsLimitedAndDepthOfNodesIsNot) {
    const std::string deep =
        gltf_with(json("'extras': ") + std::string(100, '[') + std::string(100, ']'));
    EXPECT_TRUE(read_gltf(deep).says("nested deeper than 64"));
    std::string nodes = "'nodes': [{}";
    for (int i = 0; i < 100'000; ++i) nodes += ", {'children': [" + std::to_string(i) + "]}";
    const auto read = read_gltf(gltf_with(json(nodes + "]")));
    EXPECT_TRUE(read.is_good()) << read.findings();
    EXPECT_EQ(read.document.nodes.size(), 100'001u);
}

TEST(GltfDocument, JsonThatNeedsMuchMemoryForItsSizeIsRefused) {
    // An object of three bytes counts as eight values: 125 000 of them make a million.
    const auto objects = [](std::size_t count) {
        std::string text = R"({"asset": {"version": "2.0"}, "extras": [{})";
        for (std::size_t i = 1; i < count; ++i) text += ",{}";
        return text + "]}";
    };
    ImportOptions options;
    options.max_elements = 20'000'000;
    EXPECT_TRUE(read_gltf(objects(124'990), options).is_good());
    EXPECT_THROW((void)read_gltf(objects(125'000), options), Error);
    // The default limit is twenty million.
    EXPECT_TRUE(read_gltf(objects(2'400'000)).is_good());
    EXPECT_THROW((void)read_gltf(objects(2'500'000)), Error);
}

TEST(GltfDocument, ABufferOnTheNetIsOnlyRefusedWhenItIsNeeded) {
    const std::string buffer = "'buffers': [{'byteLength': 1, 'uri': 'http://x.example/y.bin'}]";
    EXPECT_TRUE(read_gltf(gltf_with(json(buffer))).is_good());
    EXPECT_FALSE(
        read_gltf(gltf_with(json(buffer + ", 'bufferViews': [{'buffer': 0, 'byteLength': 1}]")))
            .is_good());
}

TEST(GltfDocument, AnImageOnTheNetIsLeftOut) {
    const auto read = read_gltf(gltf_with(
        json("'images': [{'uri': 'https://x.example/a.png'}], 'textures': [{'source': 0}]")));
    EXPECT_TRUE(read.is_good()) << read.findings();
    EXPECT_TRUE(read.says("#/images/0/uri: not relative to the file; the image is left out"));
    EXPECT_FALSE(read.document.textures.at(0).source.has_value());
}

TEST(GltfDocument, ImagesMustBeWhatTheySay) {
    // Only the signature of a JPEG; the same declared as PNG.
    EXPECT_TRUE(read_gltf(gltf_with(json("'images': [{'uri': 'data:image/jpeg;base64,/9j/4A=='}]")))
                    .says("#/images/0: the JPEG data ends within its header"));
    EXPECT_TRUE(read_gltf(gltf_with(json("'images': [{'uri': 'data:image/png;base64,/9j/4A=='}]")))
                    .says("#/images/0: the image is image/jpeg, declared as image/png"));
    // Media types of URIs have no case.
    EXPECT_TRUE(read_gltf(gltf_with(json("'images': [{'uri': 'data:image/JPEG;base64,/9j/4A=='}]")))
                    .says("#/images/0: the JPEG data ends within its header"));
}

TEST(GltfDocument, NormalsMustBeUnitButMayBeMissing) {
    const auto file = [](double length) {
        GltfText text;
        text.floats("VEC3", {0, 0, 1, 0, length, 0});
        return read_gltf(
            text.file(json("'meshes': [{'primitives': [{'mode': 0, 'attributes': {"
                           "'NORMAL': 0}}]}]")));
    };
    EXPECT_TRUE(file(1.005).is_good());
    EXPECT_TRUE(file(1.02).is_good());
    EXPECT_TRUE(file(1.02).says("NORMAL: 1 vectors are not of unit length"));
    EXPECT_TRUE(file(0).is_good());
    EXPECT_TRUE(file(0).says("warning: #/meshes/0/primitives/0/attributes/NORMAL: 1 vectors have"));
}

TEST(GltfDocument, TimesMustAscendAndQuaternionsBeUnit) {
    const std::string animation =
        "'nodes': [{}], 'animations': [{'channels': [{'sampler': 0, 'target': {'node': 0, 'path': "
        "'rotation'}}], 'samplers': [{'input': 0, 'output': 1}]}]";
    const auto file = [&](double second_time, double w) {
        GltfText text;
        text.floats("SCALAR", {0.5, second_time});
        text.floats("VEC4", {0, 0, 0, 1, 0, 0, 0, w});
        return read_gltf(text.file(json(animation)));
    };
    EXPECT_TRUE(file(1, 1).is_good()) << file(1, 1).findings();
    EXPECT_TRUE(file(0.5, 1).says("#/animations/0/samplers/0/input: time 1, 0.5"));
    EXPECT_TRUE(
        file(1, 0.9).says("#/animations/0/channels/0/sampler: quaternion 1 is not of unit"));
}

}  // namespace
}  // namespace alhazen::testing::ALHAZEN_TEST_FILE
