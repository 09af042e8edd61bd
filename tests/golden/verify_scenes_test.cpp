/// The wide BVH agrees with brute force on every scene of the test data, and rays cross closed
/// surfaces an even number of times.

#include <gtest/gtest.h>

#include "alhazen/base/error.h"
#include "alhazen/session/load.h"
#include "alhazen/verification/verify.h"
#include "scene_files.h"
#include "support/test_data.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

/// Returns null for rejected scenes, whose messages another test checks.
std::optional<SceneDescription> readable(const std::filesystem::path& file) {
    try {
        Diagnostics diagnostics;
        return load_description(file, {}, diagnostics);
    } catch (const Error&) {
        return std::nullopt;
    }
}

std::size_t verify_all(const std::vector<std::filesystem::path>& files, std::uint64_t rays) {
    std::size_t verified = 0;
    for (const auto& file : files) {
        const auto description = readable(file);
        if (!description) continue;
        VerifyOptions options;
        options.rays = rays;
        const VerifyReport report = verify(*description, options);
        EXPECT_EQ(report.disagreements, 0u) << file;
        EXPECT_EQ(report.odd_crossings, 0u) << file;
        for (const Disagreement& d : report.reported) {
            ADD_FAILURE() << d.kind << ' ' << d.query << " found " << d.found << " expected "
                          << d.expected;
        }
        ++verified;
    }
    return verified;
}

TEST(VerifyScenes, OwnScenes) {
    std::vector<std::filesystem::path> files;
    for (const auto& entry :
         std::filesystem::directory_iterator(testing::source_folder() / "scenes")) {
        if (entry.path().extension() == ".alhazen") files.push_back(entry.path());
    }
    EXPECT_GE(verify_all(files, 4000), 3u);
}

TEST(VerifyScenes, CourseScenes) {
    ALHAZEN_NEEDS_DATA("ray");
    EXPECT_GE(verify_all(testing::files_below("ray/uw2020_yaml/assets/trace", ".yaml"), 1000), 8u);
}

TEST(VerifyScenes, RayScenes) {
    ALHAZEN_NEEDS_DATA("ray");
    EXPECT_GE(verify_all(testing::files_below("ray", ".ray"), 200), 70u);
}

TEST(VerifyScenes, StandardProceduralDatabases) {
    ALHAZEN_NEEDS_DATA("nff");
    EXPECT_GE(verify_all(testing::files_below("nff", ".nff"), 200), 14u);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
