#include "alhazen/base/inline_vector.h"

#include <gtest/gtest.h>

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using Numbers = InlineVector<int, 3>;

Numbers numbers(std::initializer_list<int> values) {
    Numbers result;
    for (const int value : values) result.push_back(value);
    return result;
}

TEST(InlineVector, GrowsToItsCapacityAndShrinks) {
    Numbers v;
    EXPECT_TRUE(v.empty());
    EXPECT_EQ(Numbers::capacity(), 3u);
    for (int i = 0; i < 3; ++i) v.push_back(10 + i);
    EXPECT_TRUE(v.full());
    EXPECT_EQ(v.size(), 3u);
    EXPECT_EQ(v.back(), 12);
    EXPECT_EQ(v[1], 11);
    v.pop_back();
    EXPECT_EQ(v.back(), 11);
    EXPECT_FALSE(v.full());
    v.clear();
    EXPECT_TRUE(v.empty());
}

TEST(InlineVector, CopiesAndCompareByTheValuesInUse) {
    Numbers a = numbers({1, 2, 3});
    a.pop_back();  // the unused element does not count
    EXPECT_EQ(a, numbers({1, 2}));
    EXPECT_NE(a, numbers({1, 3}));
    EXPECT_NE(a, numbers({1}));
    const Numbers b = a;
    EXPECT_EQ(b, a);
    Numbers c = numbers({7, 8, 9});
    c = a;
    EXPECT_EQ(c, a);
    c = *&c;
    EXPECT_EQ(c, a);
    int sum = 0;
    for (const int x : c) sum += x;
    EXPECT_EQ(sum, 3);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
