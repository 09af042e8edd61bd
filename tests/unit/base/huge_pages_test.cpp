#include "alhazen/base/huge_pages.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <vector>

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

#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
TEST(HugePages, TheNextBlockOfTheSameSizeTakesTheHoleOfTheLast) {
    struct alignas(256) Node {
        std::byte bytes[256];
    };
    // Below the size from which the C library maps blocks one by one.
    for (const std::size_t count : {300, 400}) {
        HugePageAllocator<Node> nodes;
        Node* const first = nodes.allocate(count);
        EXPECT_EQ(reinterpret_cast<std::uintptr_t>(first) % alignof(Node), 0u);
        // So that the hole does not join the free rest.
        std::vector<void*> others;
        for (std::size_t bytes = 16; bytes <= 512; bytes += 16)
            others.push_back(std::malloc(bytes));
        nodes.deallocate(first, count);
        Node* const second = nodes.allocate(count);
        EXPECT_EQ(first, second);
        nodes.deallocate(second, count);
        for (void* other : others) std::free(other);
    }
}
#endif

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
