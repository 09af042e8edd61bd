#include "alhazen/base/checksum.h"

#include <gtest/gtest.h>

#include <set>
#include <vector>

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

std::uint64_t sum_of(std::span<const std::byte> bytes) {
    Checksum sum;
    sum.add(bytes);
    return sum.value();
}

TEST(Checksum, EveryBitAndTheLengthCount) {
    for (const std::size_t length : {0u, 1u, 7u, 8u, 31u, 32u, 33u, 100u}) {
        std::vector<std::byte> bytes(length);
        for (std::size_t i = 0; i < length; ++i) bytes[i] = std::byte(37 * i);
        std::set<std::uint64_t> sums{sum_of(bytes)};
        for (std::size_t bit = 0; bit < 8 * length; ++bit) {
            bytes[bit / 8] ^= std::byte(1u << bit % 8);
            sums.insert(sum_of(bytes));
            bytes[bit / 8] ^= std::byte(1u << bit % 8);
        }
        bytes.push_back(std::byte{0});
        sums.insert(sum_of(bytes));
        EXPECT_EQ(sums.size(), 8 * length + 2) << length;
    }
}

TEST(Checksum, WordsThatChangePlacesShow) {
    Checksum a, b;
    for (const std::uint64_t word : {1, 2}) a.add(word);
    for (const std::uint64_t word : {2, 1}) b.add(word);
    EXPECT_NE(a.value(), b.value());
    const std::vector<std::uint64_t> one{1, 2, 3, 4, 5, 6, 7, 8}, two{5, 6, 7, 8, 1, 2, 3, 4};
    EXPECT_NE(sum_of(std::as_bytes(std::span(one))), sum_of(std::as_bytes(std::span(two))));
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
