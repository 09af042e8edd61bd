#include "alhazen/base/discard_pages.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "alhazen/base/huge_array.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

TEST(DiscardPages, KeepsWhatIsBesideABlock) {
    std::vector<char> v(std::size_t{4} << 20, 'a');
    const std::size_t begin = 70'001, end = v.size() - 70'003;
    discard_pages(v.data() + begin, end - begin);
    EXPECT_EQ(std::count(v.begin(), v.begin() + begin, 'a'), std::ptrdiff_t(begin));
    EXPECT_EQ(std::count(v.begin() + std::ptrdiff_t(end), v.end(), 'a'), 70'003);
#ifdef __linux__
    // New pages are zeros; those at the two ends may have been kept.
    EXPECT_GE(std::count(v.begin(), v.end(), char{}), std::ptrdiff_t(end - begin - 2 * 65536));
#endif
}

TEST(DiscardPages, ABlockMayBeWrittenAgain) {
    constexpr std::size_t kSize = std::size_t{20} << 20;
    const auto block = make_huge_array<int>(kSize);
    std::fill_n(block.get(), kSize, 1);
    discard_pages(block.get(), kSize * sizeof(int));
    std::fill_n(block.get(), kSize, 2);
    EXPECT_EQ(std::count(block.get(), block.get() + kSize, 2), std::ptrdiff_t(kSize));
}

TEST(DiscardPages, LeavesSmallBlocksAlone) {
    std::vector<int> v(1000, 7);
    discard_pages(v.data(), v.size() * sizeof(int));
    discard_pages(nullptr, 0);
    EXPECT_EQ(std::count(v.begin(), v.end(), 7), 1000);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
