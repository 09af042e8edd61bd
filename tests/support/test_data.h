#pragma once
/// Paths of test files: scenes, reference images and this checkout.

#include <gtest/gtest.h>

#include <filesystem>

namespace alhazen::testing {

/// ALHAZEN_TEST_DATA from the environment, else the folder beside the checkout.
[[nodiscard]] std::filesystem::path test_data();

/// The root of the checkout.
[[nodiscard]] std::filesystem::path source_folder();

/// True in continuous integration (CI is set in the environment), where missing data is an error.
[[nodiscard]] bool data_is_required();

}  // namespace alhazen::testing

/// Skips the test if `path` (below the test data folder) does not exist; fails it in CI.
#define ALHAZEN_NEEDS_DATA(path)                                                      \
    if (!std::filesystem::exists(alhazen::testing::test_data() / (path))) {           \
        if (alhazen::testing::data_is_required()) {                                   \
            FAIL() << "no test data at " << alhazen::testing::test_data() / (path);   \
        }                                                                             \
        GTEST_SKIP() << "no test data at " << alhazen::testing::test_data() / (path); \
    }                                                                                 \
    static_assert(true)
