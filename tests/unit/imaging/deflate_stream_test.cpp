#include "alhazen/imaging/codecs/deflate_stream.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <array>
#include <cstddef>
#include <random>

#include "alhazen/base/error.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using Bytes = std::vector<std::uint8_t>;

/// Bytes that compressors treat differently: none, few, noise, runs, repeated words, slopes.
Bytes bytes_of_kind(int kind, std::mt19937& random) {
    constexpr std::array<std::size_t, 6> kSizes{0, 5, 70'000, 100'000, 200'000, 300'000};
    Bytes bytes(kSizes[std::size_t(kind)]);
    for (std::size_t i = 0; i < bytes.size(); ++i) {
        switch (kind) {
            case 2:
                bytes[i] = std::uint8_t(random());
                break;
            case 3:
                bytes[i] = std::uint8_t(i / 999);
                break;
            case 4:
                bytes[i] =
                    std::uint8_t("some words that are found again and again"[random() % 4 * 9]);
                break;
            case 5:
                bytes[i] = i < 150'000 ? std::uint8_t(random() % 3) : std::uint8_t(i % 1000 / 7);
                break;
            default:
                bytes[i] = std::uint8_t(i);
        }
    }
    return bytes;
}

/// As a stream of deflate. Strategies of zlib: all of its kinds of blocks.
Bytes deflated(const Bytes& bytes, int level, int strategy) {
    z_stream stream{};
    EXPECT_EQ(deflateInit2(&stream, level, Z_DEFLATED, -15, 8, strategy), Z_OK);
    Bytes result(deflateBound(&stream, uLong(bytes.size())) + 64);
    stream.next_in = const_cast<Bytef*>(bytes.data());
    stream.avail_in = uInt(bytes.size());
    stream.next_out = result.data();
    stream.avail_out = uInt(result.size());
    EXPECT_EQ(deflate(&stream, Z_FINISH), Z_STREAM_END);
    result.resize(stream.total_out);
    deflateEnd(&stream);
    return result;
}

/// Expects that the stream ends where its bytes end.
Bytes inflated(const Bytes& stream_bytes, std::size_t most) {
    z_stream stream{};
    EXPECT_EQ(inflateInit2(&stream, -15), Z_OK);
    Bytes result(most + 1);
    stream.next_in = const_cast<Bytef*>(stream_bytes.data());
    stream.avail_in = uInt(stream_bytes.size());
    stream.next_out = result.data();
    stream.avail_out = uInt(result.size());
    EXPECT_EQ(inflate(&stream, Z_FINISH), Z_STREAM_END);
    EXPECT_EQ(stream.avail_in, 0u);
    result.resize(stream.total_out);
    inflateEnd(&stream);
    return result;
}

TEST(DeflateStream, StreamsLeftOpenContinueWithTheNext) {
    std::mt19937 random(3);
    constexpr std::array<int, 4> kStrategies{Z_DEFAULT_STRATEGY, Z_FIXED, Z_RLE, Z_HUFFMAN_ONLY};
    Bytes all, joined;
    for (const int strategy : kStrategies) {
        for (const int level : {0, 1, 6, 9}) {
            for (int kind = 0; kind < 6; ++kind) {
                const Bytes bytes = bytes_of_kind(kind, random);
                Bytes stream = deflated(bytes, level, strategy);
                leave_open(stream);
                all.insert(all.end(), bytes.begin(), bytes.end());
                joined.insert(joined.end(), stream.begin(), stream.end());
            }
        }
    }
    const Bytes last = deflated({1, 2, 3}, 6, Z_DEFAULT_STRATEGY);
    joined.insert(joined.end(), last.begin(), last.end());
    all.insert(all.end(), {1, 2, 3});
    EXPECT_EQ(inflated(joined, all.size()), all);
}

/// The empty block needs a byte of its own where fewer than three bits are left.
TEST(DeflateStream, StreamsMayEndAtAnyBit) {
    std::mt19937 random(4);
    Bytes all, joined;
    for (int turn = 0; turn < 500; ++turn) {
        Bytes bytes(1 + random() % 60);
        for (std::uint8_t& byte : bytes) byte = std::uint8_t(random() % 200);
        Bytes stream = deflated(bytes, 6, turn % 2 == 0 ? Z_FIXED : Z_HUFFMAN_ONLY);
        leave_open(stream);
        all.insert(all.end(), bytes.begin(), bytes.end());
        joined.insert(joined.end(), stream.begin(), stream.end());
    }
    const Bytes last = deflated({}, 6, Z_DEFAULT_STRATEGY);
    joined.insert(joined.end(), last.begin(), last.end());
    EXPECT_EQ(inflated(joined, all.size()), all);
}

TEST(DeflateStream, BytesBehindTheStreamAreRefused) {
    Bytes stream = deflated({7, 7, 7, 8}, 6, Z_DEFAULT_STRATEGY);
    stream.push_back(0);
    EXPECT_THROW(leave_open(stream), Error);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
