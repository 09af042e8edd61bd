#include "alhazen/simd/targets.h"

#include <gtest/gtest.h>

#include "alhazen/base/error.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

TEST(SimdTargets, TheBestOneIsUsedUnlessAnotherIsForced) {
    const auto names = simd_targets();
    ASSERT_FALSE(names.empty());
    EXPECT_EQ(simd_target(), names.front());
    {
        const SimdTargetOverride outer(names.back());
        EXPECT_EQ(simd_target(), names.back());
        {
            const SimdTargetOverride inner(names.front());
            EXPECT_EQ(simd_target(), names.front());
        }
        EXPECT_EQ(simd_target(), names.back());
    }
    EXPECT_EQ(simd_target(), names.front());
    EXPECT_EQ(simd_targets(), names);
}

TEST(SimdTargets, AnUnknownNameIsRefusedAndChangesNothing) {
    const std::string before = simd_target();
    try {
        const SimdTargetOverride unknown("MMX");
        FAIL() << "an unknown name was taken";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::Usage);
        EXPECT_NE(std::string(error.what()).find(before), std::string::npos) << error.what();
    }
    EXPECT_EQ(simd_target(), before);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
