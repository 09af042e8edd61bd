#include "alhazen/base/mappable_vector.h"

#include <gtest/gtest.h>

#include <memory>
#include <utility>
#include <vector>

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using Values = std::vector<int>;

MappableVector<int> mapped(const std::shared_ptr<Values>& owner) {
    return {std::span<const int>(*owner), owner};
}
Values read(const MappableVector<int>& vector) {
    return {vector.begin(), vector.end()};
}

TEST(MappableVector, GrowsLikeAVector) {
    MappableVector<int> v;
    for (int i = 0; i < 1000; ++i) EXPECT_EQ(v.emplace_back(i), i);
    v.push_back(7);
    const Values more{8, 9};
    v.append(more);
    v[0] = 5;
    v.shrink_to_fit();
    EXPECT_EQ(v.size(), 1003u);
    EXPECT_EQ(std::as_const(v)[0], 5);
    EXPECT_EQ(std::as_const(v)[1002], 9);
    EXPECT_FALSE(v.is_mapped());
    v.resize(1);
    EXPECT_EQ(read(v), Values{5});
}

TEST(MappableVector, NewValuesOfATypeWithAConstructorAreMade) {
    struct Made {
        int seven = 7;
        int zero;
    };
    MappableVector<Made> v;
    v.reserve(8);
    for (std::size_t size = 1; size <= 8; ++size) {
        v.resize(size);
        EXPECT_EQ(v[size - 1].seven, 7);
        EXPECT_EQ(v[size - 1].zero, 0);
    }
    v.resize(0);
    v.resize(2);
    EXPECT_EQ(v[1].seven, 7);
}

TEST(MappableVector, ReadsTheMemoryOfItsOwnerAndKeepsItAlive) {
    auto owner = std::make_shared<Values>(Values{1, 2, 3});
    const int* const place = owner->data();
    const std::weak_ptr<Values> watch = owner;
    {
        const MappableVector<int> v = mapped(owner);
        owner.reset();
        EXPECT_FALSE(watch.expired());
        EXPECT_TRUE(v.is_mapped());
        EXPECT_EQ(v.data(), place);
        EXPECT_EQ(read(v), (Values{1, 2, 3}));
    }
    EXPECT_TRUE(watch.expired());
}

TEST(MappableVector, ChangesACopyOfWhatIsMapped) {
    const auto owner = std::make_shared<Values>(Values{1, 2, 3});
    MappableVector<int> v = mapped(owner);
    v[1] = 20;
    EXPECT_FALSE(v.is_mapped());
    EXPECT_EQ(read(v), (Values{1, 20, 3}));
    EXPECT_EQ(*owner, (Values{1, 2, 3}));
    MappableVector<int> grown = mapped(owner);
    grown.push_back(4);
    EXPECT_EQ(read(grown), (Values{1, 2, 3, 4}));
    EXPECT_EQ(owner.use_count(), 1);
}

TEST(MappableVector, CopiesAndMovesKeepTheirValues) {
    const auto owner = std::make_shared<Values>(Values{1, 2});
    for (const bool of_owner : {false, true}) {
        MappableVector<int> v = mapped(owner);
        if (!of_owner) v[0] = 1;
        MappableVector<int> copy = v;
        v = MappableVector<int>{};
        EXPECT_TRUE(v.empty());
        EXPECT_EQ(read(copy), (Values{1, 2}));
        const MappableVector<int> moved = std::move(copy);
        EXPECT_EQ(read(moved), (Values{1, 2}));
        EXPECT_TRUE(copy.empty());  // NOLINT: moved from on purpose
        v = moved;
        EXPECT_EQ(read(v), (Values{1, 2}));
        EXPECT_EQ(v.is_mapped(), of_owner);
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
