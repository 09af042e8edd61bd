/// Files of Bezier patches: grammar, welding, the models of the data folder, malformed files.

#include "alhazen/formats/bpt/bpt_reader.h"

#include <gtest/gtest.h>

#include <cmath>

#include "alhazen/base/file.h"
#include "support/test_data.h"
#include "unit/formats/import_text.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::import_text;
using testing::mentions;
using testing::text_of;

std::vector<BptMesh> meshes_of(const std::string& text, Diagnostics& found) {
    return read_bpt(text, "a.bpt", {}, found);
}

/// A bilinear patch whose corner is (x, 0, 0).
std::string quad(int x) {
    const std::string a = std::to_string(x), b = std::to_string(x + 1);
    return "1 1\n" + a + " 0 0\n" + a + " 1 0\n" + b + " 0 0\n" + b + " 1 0\n";
}

TEST(Bpt, PatchesOfOneDegreeShareTheirControlPoints) {
    Diagnostics found;
    const auto meshes = meshes_of("# a comment\n2 # of them\n" + quad(0) + "\n\n" + quad(1), found);
    EXPECT_EQ(text_of(found), "");
    ASSERT_EQ(meshes.size(), 1u);
    EXPECT_EQ(meshes[0].mesh.patch_count(), 2u);
    EXPECT_EQ(meshes[0].mesh.points.size(), 6u);
    EXPECT_EQ(meshes[0].mesh.patches, (std::vector<std::uint32_t>{0, 1, 2, 3, 2, 3, 4, 5}));
    EXPECT_EQ(meshes[0].location.line, 3);
}

TEST(Bpt, DegreesMayDifferFromPatchToPatch) {
    Diagnostics found;
    const auto meshes = meshes_of(
        "3\n" + quad(0) + "2 1\n0 0 0  0 1 0\n1 0 1  1 1 1\n2 0 0  2 1 0\n" + quad(4), found);
    EXPECT_EQ(text_of(found), "");
    ASSERT_EQ(meshes.size(), 2u);
    EXPECT_EQ(meshes[0].mesh.patch_count(), 2u);
    EXPECT_EQ(meshes[1].mesh.degree_u, 2u);
    EXPECT_EQ(meshes[1].mesh.degree_v, 1u);
    EXPECT_EQ(meshes[1].mesh.points[2], (Vec3{1, 0, 1}));
}

TEST(Bpt, EveryFindingHasItsPlace) {
    const std::vector<std::pair<std::string, std::string>> cases{
        {"2\n" + quad(0), "a.bpt:7:1: error: the file ends after 1 of 2 patches"},
        {"1\n1 1\n0 0 0\n0 1 0\n", "a.bpt:5:1: error: patch 1 has 2 points; its degrees require 4"},
        {"2\n1 1\n0 0 0\n0 1 0\n1 0 0\n" + quad(1),
         "a.bpt:6:1: error: patch 1 has 3 points; its degrees require 4"},
        {"2\n" + quad(0) + "7 7 7\n" + quad(1),
         "a.bpt:7:1: error: expected the two degrees of patch 2, found a point: the patch before"},
        {"1\n3 40\n0 0 0\n", "a.bpt:2:1: error: patch 1: degrees are from 1 to 7, not 40"},
        {"1\n0 1\n0 0 0\n0 0 0\n", "a.bpt:2:1: error: patch 1: degrees are from 1 to 7, not 0"},
        {"1\n1 1\n0 nan 0\n0 1 0\n1 0 0\n1 1 0\n",
         "a.bpt:3:3: error: expected a number, found 'nan'"},
        {"1\n1 1\n0 1e999 0\n0 1 0\n1 0 0\n1 1 0\n", "a.bpt:3:3: error: expected a number"},
        {"1\n1 1\n0 0\n0 1 0\n1 0 0\n1 1 0\n",
         "a.bpt:3:1: error: patch 1 has 0 points; its degrees require 4"},
        {"1\n1 1\n0 0.5\n0 1 0\n1 0 0\n1 1 0\n",
         "a.bpt:3:6: error: a point has three numbers, found 2"},
        {"-3\n" + quad(0), "a.bpt:1:1: error: expected the number of patches, found '-3'"},
        {quad(0), "a.bpt:1:1: error: expected the number of patches before the first patch"},
        {"9999999999999999999\n", "expected the number of patches"},
        {"# nothing\n", "error: the file has no patches"},
    };
    for (const auto& [text, finding] : cases) {
        Diagnostics found;
        EXPECT_TRUE(meshes_of(text, found).empty()) << text;
        EXPECT_TRUE(mentions(found, finding)) << finding << "\n" << text_of(found);
    }
}

TEST(Bpt, AFileIsReadOnAfterAnError) {
    Diagnostics found;
    (void)meshes_of("3\n40 40\n1 2 x\n" + quad(0) + "1 1\n0 0 0\n" + quad(1) + "1 9\n", found);
    EXPECT_TRUE(mentions(found, "a.bpt:2:1:")) << text_of(found);
    EXPECT_TRUE(mentions(found, "has 1 points")) << text_of(found);
    EXPECT_TRUE(mentions(found, "not 9")) << text_of(found);
}

TEST(Bpt, CountsReserveNothingAndErrorsAreBounded) {
    Diagnostics found;
    (void)meshes_of("900000000000\n900 900\n", found);
    std::string bad = "5000\n";
    for (int i = 0; i < 5000; ++i) bad += "1 1\n0 0 q\n0 0 0\n0 0 0\n0 0 0\n";
    (void)meshes_of(bad, found);
    EXPECT_LT(found.error_count(), 60u);
    Diagnostics more;
    EXPECT_EQ(meshes_of("1\n" + quad(0) + quad(1), more).front().mesh.patch_count(), 2u);
    EXPECT_TRUE(mentions(more, "a.bpt:7:1: warning: there are more patches than the 1"));
    EXPECT_EQ(more.error_count(), 0u);
}

TEST(Bpt, TheModelsHaveTheAreaAndVolumeOfTheirDescription) {
    ALHAZEN_NEEDS_DATA("patches/teapot.bpt");
    struct Model {
        const char* file;
        std::size_t patches, points;
        double area, volume;
    };
    for (const Model& model :
         {Model{"teapot.bpt", 32, 290, 52.88330309, -25.9298127534},
          Model{"teapot_commented.bpt", 32, 290, 52.88330309, -25.9298127534},
          Model{"teapotCGA.bpt", 32, 290, 0, 0}, Model{"teapot_sjbaker.bpt", 32, 290, 0, 0},
          Model{"teacup_sjbaker.bpt", 26, 0, 9.981697616, 0.22532172992}}) {
        const auto path = testing::test_data() / "patches" / model.file;
        Diagnostics found;
        const SceneDescription scene = import_text(read_file(path), path, found);
        ASSERT_EQ(text_of(found), "") << model.file;
        EXPECT_EQ(scene.format, "bpt");
        const auto& mesh =
            std::get<PatchMesh>(std::get<AnyShape>(scene.objects.at(0).parts.at(0).what));
        EXPECT_EQ(mesh.patch_count(), model.patches) << model.file;
        if (model.points != 0) {
            EXPECT_EQ(mesh.points.size(), model.points) << model.file;
        }
        const PatchMeasures measures = measures_of(mesh);
        if (model.area == 0) continue;
        EXPECT_NEAR(measures.area, model.area, 1e-8) << model.file;
        EXPECT_NEAR(measures.flux_volume, model.volume, 1e-9) << model.file;
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
