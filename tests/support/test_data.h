#pragma once
/// Where the real scenes and reference images are. Tests that need them skip, and say so, where
/// they are not.

#include <cstdlib>
#include <filesystem>
#include <string>

namespace alhazen::testing {

/// ALHAZEN_TEST_DATA from the environment, else the folder beside the checkout.
inline std::filesystem::path test_data() {
    const char* folder = std::getenv("ALHAZEN_TEST_DATA");
    return folder != nullptr ? folder : ALHAZEN_TEST_DATA_DEFAULT;
}

}  // namespace alhazen::testing

/// Skips the test when `path` (below the test data folder) does not exist.
#define ALHAZEN_NEEDS_DATA(path)                                                      \
    if (!std::filesystem::exists(alhazen::testing::test_data() / (path))) {           \
        GTEST_SKIP() << "no test data at " << alhazen::testing::test_data() / (path); \
    }                                                                                 \
    static_assert(true)
