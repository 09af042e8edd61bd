/// Generators of the Standard Procedural Databases against the files written by the original ones,
/// number for number.

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <sstream>

#include "alhazen/session/generators/generate.h"
#include "scene_files.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

/// Equal words, or two numbers that are only rounding error, even in a file of six digits.
bool equal_words(const std::string& a, const std::string& b) {
    if (a == b) return true;
    constexpr double kRoundingError = 1e-12;
    char *a_end = nullptr, *b_end = nullptr;
    const double x = std::strtod(a.c_str(), &a_end), y = std::strtod(b.c_str(), &b_end);
    return *a_end == 0 && *b_end == 0 && std::abs(x) < kRoundingError &&
           std::abs(y) < kRoundingError;
}

void expect_equal(const std::string& generated, const std::filesystem::path& path) {
    std::ifstream file(path);
    std::istringstream ours(generated);
    std::string expected, found;
    std::size_t word = 0;
    for (; file >> expected; ++word) {
        ASSERT_TRUE(ours >> found) << path << ": ends at word " << word;
        ASSERT_TRUE(equal_words(found, expected))
            << path << ": word " << word << " is " << found << ", expected " << expected;
    }
    EXPECT_GT(word, 50u) << path;
    EXPECT_FALSE(ours >> found) << path << ": more than the file, from " << found;
}

TEST(SpdFiles, OfThePublishedSizesAreGeneratedNumberForNumber) {
    ALHAZEN_NEEDS_DATA("nff/spd_default");
    for (const auto& [name, size] :
         {std::pair{"balls", 4}, {"gears", 4}, {"teapot", 12}, {"tetra", 6}}) {
        const std::string file = std::string(name) + "_s" + std::to_string(size) + ".nff";
        expect_equal(generate_nff(name), testing::test_data() / "nff/spd_default" / file);
    }
}

TEST(SpdFiles, OfSmallSizesAreGeneratedNumberForNumber) {
    ALHAZEN_NEEDS_DATA("nff/spd_small");
    constexpr std::pair<const char*, std::uint64_t> kFiles[] = {
        {"balls", 2},    {"gears", 1},  {"jacks", 1}, {"rings", 2},
        {"sombrero", 1}, {"teapot", 4}, {"tetra", 3}, {"tree", 4}};
    for (const auto& [name, size] : kFiles) {
        const std::string file = std::string(name) + "_s" + std::to_string(size) + ".nff";
        expect_equal(generate_nff(name, size), testing::test_data() / "nff/spd_small" / file);
    }
}

/// Compares everything except the heights, whose random numbers are unknown.
TEST(SpdFiles, TheMountainStandsWhereThePublishedOneDoes) {
    ALHAZEN_NEEDS_DATA("nff/spd_small");
    std::ifstream file(testing::test_data() / "nff/spd_small/mount_s3.nff");
    std::istringstream ours(generate_nff("mount", 3));
    std::string a, b;
    int lines = 0, ground = 0;
    for (; std::getline(file, a); ++lines) {
        ASSERT_TRUE(std::getline(ours, b));
        std::istringstream words(a);
        double x = 0, y = 0, z = 0;
        if (words >> x >> y >> z) {  // a vertex: same x and y, and sea level on the border
            ++ground;
            a.erase(a.rfind(' '));
            b.erase(b.rfind(' '));
        }
        std::istringstream expected(a), found(b);
        std::string p, q;
        while (expected >> p) {
            ASSERT_TRUE(found >> q);
            EXPECT_TRUE(equal_words(p, q)) << "line " << lines << ": " << a << " is " << b;
        }
    }
    EXPECT_EQ(ground, 128 * 3);
    EXPECT_FALSE(std::getline(ours, b));
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
