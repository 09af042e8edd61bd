/// Renders of the course's scenes match the course's own images.

#include <gtest/gtest.h>

#include "alhazen/imaging/codecs/image_io.h"
#include "alhazen/imaging/image/image_difference.h"
#include "alhazen/session/load.h"
#include "alhazen/session/picture.h"
#include "alhazen/session/render.h"
#include "scene_files.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

const std::string kTrace = "ray/uw2020_yaml/assets/trace";

/// "box_3" -> box.yaml, anywhere below the trace folder.
std::filesystem::path scene_of(const std::filesystem::path& solution) {
    const std::string stem = solution.stem().string();
    const std::string name = stem.substr(0, stem.rfind('_')) + ".yaml";
    for (const auto& file : testing::files_below(kTrace, ".yaml")) {
        if (file.filename() == name) return file;
    }
    return {};
}

/// Compares through a PNG file, as a user would.
ImageDifference against_solution(const std::filesystem::path& solution,
                                 const std::string& accelerator) {
    LoadOptions options;
    options.compile.accelerator = accelerator;
    const LoadedScene loaded = load(scene_of(solution), options);
    const RenderResult result = render(loaded.scene, loaded.description.picture, {});
    const std::filesystem::path picture =
        std::filesystem::path(::testing::TempDir()) / ("course_" + solution.filename().string());
    write_picture(picture, result.film, loaded.scene.conventions.film, {});
    const Image ours = read_image(picture);
    const Image theirs = read_image(solution);
    const ImageDifference d = difference(ours, theirs);
    if (d.identical < d.pixels) {
        write_image(picture.parent_path() / ("difference_" + solution.filename().string()),
                    difference_image(ours, theirs));
    }
    return d;
}

TEST(CourseImages, EverySolutionIsMetInAtLeast9995OfTenThousandPixels) {
    ALHAZEN_NEEDS_DATA(kTrace);
    const auto solutions = testing::files_below(kTrace + "/solution", ".png");
    ASSERT_GE(solutions.size(), 8u);
    for (const auto& solution : solutions) {
        const ImageDifference d = against_solution(solution, "wide_bvh");
        const double pixels = static_cast<double>(d.pixels);
        const double identical = static_cast<double>(d.identical) / pixels;
        const double close = static_cast<double>(d.within_one_step) / pixels;
        EXPECT_GE(identical, 0.9999) << solution;
        EXPECT_GE(close, 0.99999) << solution;
        RecordProperty(solution.stem().string(), std::to_string(100 * identical));
    }
}

TEST(CourseImages, BruteForceGivesTheSameBitsAndCountsAsTheWideBvh) {
    ALHAZEN_NEEDS_DATA(kTrace);
    const auto solution = testing::test_data() / kTrace / "solution/box_cyl_trans_shadow_3.png";
    LoadOptions list;
    list.compile.accelerator = "list";
    const LoadedScene brute = load(scene_of(solution), list);
    const LoadedScene fast = load(scene_of(solution), {});
    RenderOptions many;
    many.tile_size = 17;
    RenderOptions one;
    one.threads = 1;
    const RenderResult a = render(brute.scene, brute.description.picture, many);
    const RenderResult b = render(fast.scene, fast.description.picture, one);
    const PixelBox& crop = a.film.crop();
    ASSERT_EQ(crop, b.film.crop());
    for (int y = crop.y0; y < crop.y1; ++y) {
        for (int x = crop.x0; x < crop.x1; ++x) ASSERT_EQ(a.film.at(x, y), b.film.at(x, y));
    }
    for (std::size_t i = 0; i < a.counters.rays.size(); ++i) {
        EXPECT_EQ(a.counters.rays[i].cast, b.counters.rays[i].cast);
        EXPECT_EQ(a.counters.rays[i].hit, b.counters.rays[i].hit);
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
