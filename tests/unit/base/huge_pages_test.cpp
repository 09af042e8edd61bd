#include "alhazen/base/huge_pages.h"

#include <gtest/gtest.h>

#include <cstdint>

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

TEST(HugePages, ALargeVectorStandsOnTheBoundaryOfALargePage) {
    HugeVector<int> v(kHugePageBytes / sizeof(int), 7);
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(v.data()) % kHugePageBytes, 0u);
    v.resize(3 * v.size());
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(v.data()) % kHugePageBytes, 0u);
    EXPECT_EQ(v.front(), 7);
    HugeVector<int> few(10, 1);
    EXPECT_EQ(few.back(), 1);
}

TEST(HugePages, CollapsingKeepsWhatIsThere) {
    std::vector<int> v(3 * kHugePageBytes / sizeof(int));
    for (std::size_t i = 0; i < v.size(); ++i) v[i] = static_cast<int>(i);
    collapse_to_huge_pages(std::span(v));
    collapse_to_huge_pages(nullptr, 0);
    for (std::size_t i = 0; i < v.size(); ++i) ASSERT_EQ(v[i], static_cast<int>(i));
}

TEST(HugePages, MoreThanThereIsOfMemoryIsRefused) {
    EXPECT_THROW((void)HugePageAllocator<double>().allocate(static_cast<std::size_t>(-1) / 2),
                 std::bad_alloc);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
