#include <gtest/gtest.h>

#include "alhazen/formats/gltf/document/gltf_accessors.h"
#include "unit/formats/gltf/gltf_read.h"

namespace alhazen::testing::ALHAZEN_TEST_FILE {
namespace {

using Numbers = std::vector<double>;

/// One buffer with these bytes, one view of all of it (`view` adds members), and these accessors.
std::string over(const std::string& bytes, const std::string& accessors,
                 const std::string& view = "") {
    const std::string size = std::to_string(bytes.size());
    return gltf_with(json("'buffers': [{'byteLength': " + size +
                          ", 'uri': 'data:application/octet-stream;base64," + base64(bytes) +
                          "'}], 'bufferViews': [{'buffer': 0, 'byteLength': " + size + view +
                          "}], 'accessors': [" + accessors + "]"));
}

TEST(GltfAccessor, FloatsComeBackAsTheyWere) {
    const auto read = read_gltf(over(bytes_of_numbers<float>({1, 2.5, -3, 0.1, 0, 7}),
                                     "{'bufferView': 0, 'componentType': 5126, 'count': 2, "
                                     "'type': 'VEC3'}"));
    ASSERT_TRUE(read.is_good()) << read.findings();
    EXPECT_EQ(gltf::read_numbers(read.document, 0), (Numbers{1, 2.5, -3, double{0.1f}, 0, 7}));
}

TEST(GltfAccessor, InterleavedElementsAreAStrideApart) {
    const auto read = read_gltf(over(
        bytes_of_numbers<float>({1, 2, 9, 3, 4, 8}),
        "{'bufferView': 0, 'componentType': 5126, 'count': 2, 'type': 'VEC2'},"
        "{'bufferView': 0, 'byteOffset': 8, 'componentType': 5126, 'count': 2, 'type': 'SCALAR'}",
        ", 'byteStride': 12"));
    ASSERT_TRUE(read.is_good()) << read.findings();
    EXPECT_EQ(gltf::read_numbers(read.document, 0), (Numbers{1, 2, 3, 4}));
    EXPECT_EQ(gltf::read_numbers(read.document, 1), (Numbers{9, 8}));
}

TEST(GltfAccessor, NormalisedBytesReachExactlyMinusOneAndOne) {
    const auto read = read_gltf(over(bytes_of_numbers<signed char>({-128, -127, 0, 127}),
                                     "{'bufferView': 0, 'componentType': 5120, 'count': 4, "
                                     "'type': 'SCALAR', 'normalized': true}"));
    ASSERT_TRUE(read.is_good()) << read.findings();
    EXPECT_EQ(gltf::read_numbers(read.document, 0), (Numbers{-1, -1, 0, 1}));
}

TEST(GltfAccessor, NormalisedUnsignedShortsAreDividedByTheirLargest) {
    const auto read = read_gltf(over(bytes_of_numbers<unsigned short>({0, 65535, 13107}),
                                     "{'bufferView': 0, 'componentType': 5123, 'count': 3, "
                                     "'type': 'SCALAR', 'normalized': true}"));
    ASSERT_TRUE(read.is_good()) << read.findings();
    EXPECT_EQ(gltf::read_numbers(read.document, 0), (Numbers{0, 1, 13107 / 65535.0}));
    EXPECT_EQ(gltf::read_integers(read.document, 0), (std::vector<std::uint32_t>{0, 65535, 13107}));
}

TEST(GltfAccessor, SparseValuesReplaceThoseOfTheBase) {
    // Four floats, then two indices (bytes, padded), then two values.
    const std::string bytes = bytes_of_numbers<float>({1, 2, 3, 4}) +
                              std::string("\x01\x03\0\0", 4) + bytes_of_numbers<float>({20, 40});
    const auto read = read_gltf(
        over(bytes,
             "{'bufferView': 0, 'componentType': 5126, 'count': 4, 'type': 'SCALAR', 'min': [1], "
             "'max': [40], 'sparse': {'count': 2, 'indices': {'bufferView': 0, 'byteOffset': 16, "
             "'componentType': 5121}, 'values': {'bufferView': 0, 'byteOffset': 20}}}"));
    ASSERT_TRUE(read.is_good()) << read.findings();
    EXPECT_EQ(gltf::read_numbers(read.document, 0), (Numbers{1, 20, 3, 40}));
    // Reads only the first elements, with the sparse values among them.
    EXPECT_EQ(gltf::read_numbers(read.document, 0, 1), (Numbers{1}));
    EXPECT_EQ(gltf::read_numbers(read.document, 0, 3), (Numbers{1, 20, 3}));
    EXPECT_EQ(gltf::read_numbers(read.document, 0, 9), (Numbers{1, 20, 3, 40}));
}

TEST(GltfAccessor, WithoutAViewTheBaseOfSparseValuesIsZero) {
    const std::string bytes = std::string("\x02\0\0\0", 4) + bytes_of_numbers<float>({5, 6});
    const auto read = read_gltf(
        over(bytes,
             "{'componentType': 5126, 'count': 3, 'type': 'VEC2', 'min': [0, 0], 'max': [5, "
             "6], 'sparse': {'count': 1, 'indices': {'bufferView': 0, 'componentType': "
             "5125}, 'values': {'bufferView': 0, 'byteOffset': 4}}}"));
    ASSERT_TRUE(read.is_good()) << read.findings();
    EXPECT_EQ(gltf::read_numbers(read.document, 0), (Numbers{0, 0, 0, 0, 5, 6}));
}

TEST(GltfAccessor, ColumnsOfSmallMatricesBeginAtMultiplesOfFour) {
    const std::string bytes("\x01\x02\0\0\x03\x04", 6);
    const auto read =
        read_gltf(over(bytes + std::string(2, '\0') + bytes,
                       "{'bufferView': 0, 'componentType': 5121, 'count': 2, 'type': 'MAT2'}"));
    ASSERT_TRUE(read.is_good()) << read.findings();
    EXPECT_EQ(gltf::read_numbers(read.document, 0), (Numbers{1, 2, 3, 4, 1, 2, 3, 4}));
}

TEST(GltfAccessor, LayoutOfMatricesIsThatOfTheSpecification) {
    using gltf::ComponentType;
    using gltf::ElementType;
    const auto bytes = gltf::layout_of(ComponentType::Byte, ElementType::Mat3);
    EXPECT_EQ(bytes.size, 11u);
    EXPECT_EQ(bytes.packed, 12u);
    const auto shorts = gltf::layout_of(ComponentType::Short, ElementType::Mat3);
    EXPECT_EQ(shorts.size, 22u);
    EXPECT_EQ(shorts.packed, 24u);
    const auto floats = gltf::layout_of(ComponentType::Float, ElementType::Mat4);
    EXPECT_EQ(floats.size, 64u);
    EXPECT_EQ(floats.packed, 64u);
}

struct RefusedAccessor {
    const char* name;
    const char* accessor;
    const char* finding;  ///< part of the message
};

class GltfAccessorRefusal : public ::testing::TestWithParam<RefusedAccessor> {};

TEST_P(GltfAccessorRefusal, NamesThePlace) {
    const auto read = read_gltf(over(bytes_of_numbers<float>({1, 2, 3, 4}), GetParam().accessor));
    EXPECT_FALSE(read.is_good());
    EXPECT_TRUE(read.says(GetParam().finding)) << read.findings();
}

INSTANTIATE_TEST_SUITE_P(
    All, GltfAccessorRefusal,
    ::testing::Values(
        RefusedAccessor{"TooLong",
                        "{'bufferView': 0, 'componentType': 5126, 'count': 5, 'type': 'SCALAR'}",
                        "#/accessors/0: 5 elements"},
        RefusedAccessor{"OffsetBeyond",
                        "{'bufferView': 0, 'byteOffset': 9007199254740988, 'componentType': 5126, "
                        "'count': 1, 'type': 'SCALAR'}",
                        "#/accessors/0: 1 elements"},
        RefusedAccessor{
            "CountThatOverflows",
            "{'bufferView': 0, 'componentType': 5126, 'count': 400000000, 'type': 'MAT4'}",
            "#/accessors/0: 400000000 elements"},
        RefusedAccessor{
            "Unaligned",
            "{'bufferView': 0, 'byteOffset': 2, 'componentType': 5126, 'count': 1, 'type': "
            "'SCALAR'}",
            "#/accessors/0: byteOffset must be a multiple of 4"},
        RefusedAccessor{"NoCount", "{'bufferView': 0, 'componentType': 5126, 'type': 'SCALAR'}",
                        "#/accessors/0: \"count\" is missing"},
        RefusedAccessor{"NegativeCount",
                        "{'bufferView': 0, 'componentType': 5126, 'count': -1, 'type': 'SCALAR'}",
                        "#/accessors/0/count: expected an integer from 1, found -1"},
        RefusedAccessor{"LargeCount",
                        "{'bufferView': 0, 'componentType': 5126, 'count': 9007199254740992, "
                        "'type': 'SCALAR'}",
                        "#/accessors/0/count: expected an integer from 1 to 9007199254740991, "
                        "found 9007199254740992"},
        RefusedAccessor{"NoSuchView",
                        "{'bufferView': 7, 'componentType': 5126, 'count': 1, 'type': 'SCALAR'}",
                        "#/accessors/0/bufferView: there is no bufferView 7 (the file has 1)"},
        RefusedAccessor{"NormalisedFloats",
                        "{'bufferView': 0, 'componentType': 5126, 'count': 1, 'type': 'SCALAR', "
                        "'normalized': true}",
                        "#/accessors/0/normalized"},
        RefusedAccessor{
            "WrongMinimum",
            "{'bufferView': 0, 'componentType': 5126, 'count': 4, 'type': 'SCALAR', 'min': "
            "[0.5], 'max': [4]}",
            "#/accessors/0/min/0: declared 0.5, found 1"},
        RefusedAccessor{
            "SparseIndicesThatDescend",
            "{'componentType': 5126, 'count': 4, 'type': 'SCALAR', 'sparse': {'count': 2, "
            "'indices': {'bufferView': 0, 'componentType': 5121}, 'values': {'bufferView': 0}}}",
            "#/accessors/0/sparse/indices: index 1"}),
    [](const auto& test) { return std::string(test.param.name); });

TEST(GltfAccessor, InfiniteNumbersAreRefused) {
    const double inf = std::numeric_limits<double>::infinity();
    for (const double bad : {inf, -inf, std::numeric_limits<double>::quiet_NaN()}) {
        const auto read = read_gltf(over(bytes_of_numbers<float>({1, bad, 3}),
                                         "{'bufferView': 0, 'componentType': 5126, 'count': 3, "
                                         "'type': 'SCALAR'}"));
        EXPECT_TRUE(read.says("#/accessors/0: there are infinite or NaN numbers")) << bad;
    }
}

TEST(GltfAccessor, ZerosWithoutAViewAreLimited) {
    const std::string text =
        gltf_with(json("'accessors': [{'componentType': 5126, 'count': 1000, 'type': 'VEC4'}]"));
    ImportOptions options;
    options.max_elements = 16 * 4000;
    const auto read = read_gltf(text, options);
    ASSERT_TRUE(read.is_good()) << read.findings();
    EXPECT_EQ(gltf::read_numbers(read.document, 0), Numbers(4000, 0.0));
    options.max_elements = 16 * 4000 - 16;
    EXPECT_THROW((void)read_gltf(text, options), Error);
}

TEST(GltfAccessor, OverlappingAccessorsCannotAskForEndlessWork) {
    std::string accessors;
    for (int i = 0; i < 100; ++i) {
        accessors += (i == 0 ? "" : ",") + std::string(
                                               "{'bufferView': 0, 'componentType': 5121, "
                                               "'count': 1000, 'type': 'SCALAR'}");
    }
    ImportOptions options;
    options.max_elements = 25'000;
    EXPECT_TRUE(read_gltf(over(std::string(1000, 'x'), accessors), options).is_good());
    options.max_elements = 24'999;
    EXPECT_THROW((void)read_gltf(over(std::string(1000, 'x'), accessors), options), Error);
}

}  // namespace
}  // namespace alhazen::testing::ALHAZEN_TEST_FILE
