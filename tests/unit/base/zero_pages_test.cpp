#include "alhazen/base/zero_pages.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using Zeros = std::vector<double, ZeroPageAllocator<double>>;

TEST(ZeroPages, HoldZerosInMappingsAndInTheHeap) {
    constexpr std::size_t kLarge = ZeroPageAllocator<double>::kMapped / sizeof(double);
    for (const std::size_t size : {std::size_t{1}, std::size_t{70'000}, kLarge, kLarge + 1}) {
        for (int round = 0; round < 2; ++round) {  // the second meets what the first left
            Zeros values(size);
            ASSERT_EQ(std::count(values.begin(), values.end(), 0.0), std::ptrdiff_t(size));
            std::fill(values.begin(), values.end(), 3.5);
            const Zeros copy = values;
            EXPECT_EQ(copy.back(), 3.5);
            EXPECT_EQ(Zeros(size, 2.5).front(), 2.5);
        }
    }
}

TEST(ZeroPages, AMappingStandsOnTheBoundaryOfALargePage) {
    constexpr std::size_t kBytes = ZeroPageAllocator<char>::kMapped + 1;
    for (int i = 0; i < 5; ++i) {
        void* const memory = map_zeros(kBytes);
        EXPECT_EQ(reinterpret_cast<std::uintptr_t>(memory) % kHugePageBytes, 0u);
        static_cast<char*>(memory)[kBytes - 1] = 1;
        unmap_zeros(memory, kBytes);
    }
}

TEST(ZeroPages, MoreThanThereIsOfMemoryIsRefused) {
    const std::size_t most = static_cast<std::size_t>(-1);
    EXPECT_THROW((void)ZeroPageAllocator<double>().allocate(most / 16), std::bad_alloc);
    EXPECT_THROW((void)ZeroPageAllocator<double>().allocate(most), std::bad_alloc);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
