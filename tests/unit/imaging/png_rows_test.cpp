#include "alhazen/imaging/codecs/png_rows.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <cstddef>
#include <random>
#include <span>

#include "alhazen/base/error.h"
#include "alhazen/imaging/codecs/png.h"
#include "alhazen/parallel/parallel.h"
#include "unit/imaging/test_images.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using Bytes = std::vector<std::uint8_t>;

/// Slopes with noise in a part of the rows.
EncodedImage sloped(int width, int height, int channels, int bits) {
    std::mt19937 random(21);
    EncodedImage image{width, height, channels, bits, {}};
    const unsigned most = bits == 8 ? 255 : 65535;
    for (int y = 0; y < height; ++y) {
        for (int i = 0; i < width * channels; ++i) {
            const unsigned noise = y / 50 % 2 == 0 ? 0 : random() & 3;
            image.samples.push_back(std::uint16_t((unsigned(i / 9 + y / 3) + noise) & most));
        }
    }
    return image;
}

CodeRows rows_of(const EncodedImage& image) {
    const std::size_t row = std::size_t(image.width) * std::size_t(image.channels);
    CodeRows rows{image.width, image.height, image.channels, image.bits};
    rows.fill = [&image, row](int y, std::span<std::uint16_t> codes) {
        std::copy_n(image.samples.data() + std::size_t(y) * row, row, codes.data());
    };
    return rows;
}

Bytes joined(const std::vector<Bytes>& parts) {
    Bytes all;
    for (const Bytes& part : parts) all.insert(all.end(), part.begin(), part.end());
    return all;
}

std::size_t filtered_size(const EncodedImage& image) {
    const int row = 1 + image.width * image.channels * image.bits / 8;
    return std::size_t(row) * std::size_t(image.height);
}

Bytes decompressed(const Bytes& stream, std::size_t most) {
    Bytes result(most + 1);
    uLongf size = result.size();
    EXPECT_EQ(uncompress(result.data(), &size, stream.data(), stream.size()), Z_OK);
    result.resize(size);
    return result;
}

TEST(PngRows, BytesAreTheSameWithAnyNumberOfThreads) {
    for (const int bits : {8, 16}) {
        const EncodedImage image = sloped(700, 900, 3, bits);
        Bytes with_one;
        for (const int threads : {1, 2, 3, 7}) {
            Bytes bytes;
            ThreadLimit(threads).run([&] { bytes = joined(compressed_rows(rows_of(image))); });
            if (threads == 1) with_one = bytes;
            EXPECT_EQ(bytes, with_one) << threads << " threads, " << bits << " bits";
        }
        EXPECT_EQ(decompressed(with_one, filtered_size(image)).size(), filtered_size(image));
    }
}

TEST(PngRows, PicturesOfManyPiecesAreReadAsTheyWere) {
    for (int channels = 1; channels <= 4; ++channels) {
        for (const int bits : {8, 16}) {
            for (const EncodedImage& image : {sloped(811, 1301, channels, bits),
                                              testing::random_codes(900, 500, channels, bits, 5)}) {
                const std::string file = testing::as_string(encode_png(image, {}));
                const StoredImage read = decode_png(file, "a.png", {});
                const std::vector<std::uint16_t> codes = std::visit(
                    [](const auto& all) {
                        return std::vector<std::uint16_t>(all.begin(), all.end());
                    },
                    read.samples);
                EXPECT_TRUE(codes == image.samples) << channels << " channels, " << bits;
            }
        }
    }
}

/// The filter of the first row of a piece takes the row above from the piece before.
TEST(PngRows, FiltersDoNotDependOnThePieces) {
    const EncodedImage image = sloped(1024, 700, 3, 8);
    const std::vector<Bytes> parts = compressed_rows(rows_of(image));
    ASSERT_EQ(parts.size(), 8u);
    const Bytes filtered = decompressed(joined(parts), filtered_size(image));
    const std::size_t row = 1 + 3 * 1024;
    for (std::size_t y = 1; y < 700; ++y) {
        // Of a single row alone all rows but the first differ: its filter sees nothing above.
        EncodedImage two{1024, 2, 3, 8, {}};
        const auto from = image.samples.begin() + std::ptrdiff_t((y - 1) * 3 * 1024);
        two.samples.assign(from, from + 2 * 3 * 1024);
        const Bytes alone = decompressed(joined(compressed_rows(rows_of(two))), 2 * row);
        ASSERT_TRUE(std::equal(alone.begin() + std::ptrdiff_t(row), alone.end(),
                               filtered.begin() + std::ptrdiff_t(y * row)))
            << "row " << y;
    }
}

TEST(PngRows, SmallPicturesAreOnePieceAndLargeOnesLittleLarger) {
    EXPECT_EQ(compressed_rows(rows_of(sloped(350, 350, 3, 8))).size(), 1u);
    const EncodedImage image = sloped(1024, 1024, 3, 8);
    const std::vector<Bytes> parts = compressed_rows(rows_of(image));
    EXPECT_EQ(parts.size(), 12u);
    const Bytes pieces = joined(parts);
    const Bytes filtered = decompressed(pieces, filtered_size(image));
    Bytes whole(compressBound(uLong(filtered.size())));
    uLongf size = whole.size();
    ASSERT_EQ(compress2(whole.data(), &size, filtered.data(), filtered.size(), 4), Z_OK);
    EXPECT_LT(double(pieces.size()), 1.01 * double(size));
}

/// Noise, whose compressed size is that of the rows.
TEST(PngRows, ManyPiecesGetSmallerAndTwoAreEqual) {
    const auto noise = [](int height) {
        const EncodedImage image = testing::random_codes(1024, height, 3, 8, 7);
        return compressed_rows(rows_of(image));
    };
    const std::vector<Bytes> two = noise(170);
    ASSERT_EQ(two.size(), 2u);
    EXPECT_NEAR(double(two[0].size()), double(two[1].size()), 100.0);
    const std::vector<Bytes> parts = noise(1024);
    ASSERT_EQ(parts.size(), 12u);
    for (std::size_t i = 1; i < parts.size(); ++i) EXPECT_LT(parts[i].size(), parts[i - 1].size());
    EXPECT_LT(2 * parts.back().size(), parts.front().size());
}

/// Pieces of no row are left out.
TEST(PngRows, FewLongRowsAreReadAsTheyWere) {
    for (const int height : {1, 2, 3, 4, 5, 7}) {
        const EncodedImage image = sloped(90'000, height, 4, 8);
        const std::vector<Bytes> parts = compressed_rows(rows_of(image));
        EXPECT_LE(parts.size(), std::size_t(height));
        EXPECT_EQ(decompressed(joined(parts), filtered_size(image)).size(), filtered_size(image));
    }
}

TEST(PngRows, ACodeThatDoesNotFitInAnyPieceIsRefused) {
    for (const std::size_t at : {std::size_t{0}, std::size_t{1'000'000}, std::size_t{3'145'727}}) {
        EncodedImage image = sloped(1024, 1024, 3, 8);
        image.samples[at] = 256;
        EXPECT_THROW((void)compressed_rows(rows_of(image)), Error) << at;
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
