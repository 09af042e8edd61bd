#include "alhazen/formats/pictures/texture_table.h"

#include <gtest/gtest.h>

#include "alhazen/base/file.h"
#include "alhazen/imaging/codecs/image_io.h"
#include "support/image_texture.h"
#include "support/scratch_folder.h"
#include "unit/formats/gltf/gltf_text.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

/// An image of `width` x 4 pixels as a file with this suffix.
std::string picture(int width, const std::string& suffix = "png") {
    Image image;
    image.width = width;
    image.height = 4;
    image.channels = 3;
    image.linear = suffix != "png";
    image.samples.assign(std::size_t(width) * 12, 0.5F);
    std::string bytes;
    for (const std::byte b : encode_image(suffix, image)) bytes += char(b);
    return bytes;
}

/// Bytes of the 8-bit samples of picture(100), and of the row that its decoder needs.
constexpr std::uint64_t kCodes = 1200, kRow = 300;

/// Number of images that are loaded before `max_bytes` is exceeded.
std::size_t taken(const std::vector<std::string>& pictures, std::uint64_t max_bytes,
                  const ImageTexture& settings = {}) {
    SceneDescription scene;
    Diagnostics found;
    ImageLimits limits;
    limits.max_bytes = max_bytes;
    TextureTable table(scene, found, {"."}, limits);
    std::size_t count = 0;
    try {
        for (const std::string& bytes : pictures) {
            if (table.add(bytes, settings, "p", {})) ++count;
        }
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::Resource);
        EXPECT_NE(std::string(error.what()).find("--max-image-mib"), std::string::npos);
    }
    EXPECT_EQ(found.error_count(), 0U);
    return count;
}

TEST(TextureTable, AllPicturesTogetherAreLimited) {
    const std::vector<std::string> three(3, picture(100));
    const std::uint64_t each = kCodes + three[0].size();
    EXPECT_EQ(taken(three, 3 * each + kRow), 3U);
    EXPECT_EQ(taken(three, 3 * each + kRow - 1), 2U);
    EXPECT_EQ(taken(three, each + kRow - 1), 0U);
    // Floats take four times the bytes.
    const std::vector<std::string> floats(3, picture(100, "pfm"));
    EXPECT_EQ(taken(floats, 3 * (4 * kCodes + floats[0].size())), 3U);
    EXPECT_EQ(taken(floats, 3 * (4 * kCodes + floats[0].size()) - 1), 2U);
}

TEST(TextureTable, SmallerCopiesAreCountedBeforeTheyAreMade) {
    const std::vector<std::string> one{picture(100)};
    const ImageTexture mipmapped{.filter = TextureFilter::Mipmapped};
    // 50 x 2, 25 x 1, 12, 6, 3 and 1 texels of three shorts.
    const std::uint64_t bytes = kCodes + one[0].size() + (100 + 25 + 12 + 6 + 3 + 1) * 6;
    EXPECT_EQ(taken(one, bytes, mipmapped), 1U);
    EXPECT_EQ(taken(one, bytes - 1, mipmapped), 0U);
}

TEST(TextureTable, SmallerCopiesAreCountedForColourAndForDataOnceEach) {
    SceneDescription scene;
    Diagnostics found;
    ImageLimits limits;
    const std::string bytes = picture(100);
    limits.max_bytes = kCodes + bytes.size() + 2 * 147 * 6 - 1;
    TextureTable table(scene, found, {"."}, limits);
    ImageTexture settings{.filter = TextureFilter::Mipmapped};
    EXPECT_TRUE(table.add(bytes, settings, "colour", {}));
    EXPECT_TRUE(table.add(bytes, settings, "the same", {}));
    settings.decode_srgb = true;
    EXPECT_THROW((void)table.add(bytes, settings, "data", {}), Error);
}

TEST(TextureTable, AFileCountsWhileItIsRead) {
    const testing::ScratchFolder folder;
    const std::string bytes = picture(100);
    write_file_atomically(folder.path() / "p.png", bytes);
    const auto fits = [&](std::uint64_t max_bytes) {
        SceneDescription scene;
        Diagnostics found;
        ImageLimits limits;
        limits.max_bytes = max_bytes;
        TextureTable table(scene, found, {folder.path()}, limits);
        try {
            return table.load("p.png", folder.path(), {}, "p", {}).has_value();
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::Resource);
            return false;
        }
    };
    EXPECT_TRUE(fits(bytes.size() + kCodes + kRow));
    EXPECT_FALSE(fits(bytes.size() + kCodes + kRow - 1));
    EXPECT_FALSE(fits(bytes.size() - 1));
}

TEST(TextureTable, OnePictureBeyondItsOwnLimitIsAnErrorOfResources) {
    SceneDescription scene;
    Diagnostics found;
    ImageLimits limits;
    limits.max_pixels = 399;
    TextureTable table(scene, found, {"."}, limits);
    const std::string bytes = picture(100);
    try {
        (void)table.add(bytes, {}, "p", {"scene", 3, 4});
        FAIL() << "a picture of 400 pixels was read";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::Resource);
        EXPECT_EQ(std::string(error.what()).find("scene:3:4: error: texture: p: "), 0u)
            << error.what();
    }
}

TEST(TextureTable, TheSameBytesAreOnePicture) {
    SceneDescription scene;
    Diagnostics found;
    ImageLimits limits;
    const std::string bytes = picture(100);
    limits.max_bytes = kCodes + kRow + bytes.size();
    TextureTable table(scene, found, {"."}, limits);
    for (int i = 0; i < 5; ++i) EXPECT_TRUE(table.add(bytes, {}, std::to_string(i), {}));
    EXPECT_EQ(testing::image_texture(scene.textures.at(0)).image,
              testing::image_texture(scene.textures.at(4)).image);
}

TEST(TextureTable, BytesThatManyPicturesShareAreCountedForEach) {
    SceneDescription scene;
    Diagnostics found;
    ImageLimits limits;
    limits.max_bytes = 4000;
    TextureTable table(scene, found, {"."}, limits);
    const std::string bytes = picture(1) + std::string(2000, ' ');
    const std::string_view view = bytes;
    (void)table.add(view, {}, "a", {});
    EXPECT_THROW((void)table.add(view.substr(0, view.size() - 1), {}, "b", {}), Error);
}

/// A triangle with 40 materials, textures and images that all use this file.
std::string forty_images(const std::string& png) {
    testing::GltfText t;
    const int p =
        t.floats("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0}, testing::bounds("0, 0, 0", "1, 1, 0"));
    const int uv = t.floats("VEC2", {0, 0, 1, 0, 0, 1});
    std::string images, textures, materials, primitives;
    for (int i = 0; i < 40; ++i) {
        const std::string comma = i == 0 ? "" : ", ", n = std::to_string(i);
        images += comma + R"({"bufferView": 2, "mimeType": "image/png"})";
        textures += comma + R"({"source": )" + n + "}";
        materials += comma + R"({"emissiveTexture": {"index": )" + n + "}}";
        primitives += comma + R"({"attributes": {"POSITION": )" + std::to_string(p) +
                      R"(, "TEXCOORD_0": )" + std::to_string(uv) + R"(}, "material": )" + n + "}";
    }
    std::string text = t.file(
        R"("scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}], "meshes": [{"primitives": [)" +
        primitives + R"(]}], "materials": [)" + materials + R"(], "textures": [)" + textures +
        R"(], "images": [)" + images + "]");
    const auto insert = [&](const std::string& array, const std::string& element) {
        text.insert(text.find(']', text.find('"' + array + "\": [")), ", " + element);
    };
    const std::string size = std::to_string(png.size());
    insert("bufferViews", R"({"buffer": 2, "byteLength": )" + size + "}");
    insert("buffers", R"({"byteLength": )" + size +
                          R"(, "uri": "data:application/octet-stream;base64,)" +
                          testing::base64(png) + R"("})");
    return text;
}

TEST(TextureTable, ManyImagesOfAGltfFileInOneBufferViewAreOnePicture) {
    ImportOptions options;
    const std::string png = picture(100);
    // The materials use it with mipmaps.
    options.image_limits.max_bytes = kCodes + png.size() + 147 * 6;
    const auto imported = testing::import_gltf(forty_images(png), options);
    ASSERT_EQ(imported.errors(), 0U) << imported.messages();
    ASSERT_EQ(imported.scene.textures.size(), 40U);
    for (const TextureDescription& texture : imported.scene.textures) {
        EXPECT_EQ(testing::image_texture(texture).image,
                  testing::image_texture(imported.scene.textures[0]).image);
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
