/// Cameras of BRL-CAD's views and view scripts.

#include "alhazen/formats/brlcad/brlcad_view.h"

#include <gtest/gtest.h>

#include <cmath>

#include "unit/formats/import_text.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::text_of;

const Box3 kBox{{-1, -1, -1}, {1, 1, 1}};

std::vector<CameraDescription> views_of(const std::string& text) {
    Diagnostics found;
    auto views = read_brlcad_views(text, "a.rt", kBox, found);
    EXPECT_EQ(text_of(found), "");
    return views;
}

void expect_parallel(const CameraDescription& camera, const Vec3& direction, const Vec3& right,
                     const Vec3& up) {
    const auto& view = std::get<OrthographicCamera>(camera.camera);
    EXPECT_NEAR(length(view.direction - direction), 0, 1e-12) << camera.name;
    EXPECT_NEAR(length(view.right - right), 0, 1e-12) << camera.name;
    EXPECT_NEAR(length(view.up - up), 0, 1e-12) << camera.name;
}

TEST(BrlcadView, TheDefaultIsFrom35And25AsWideAsTheDiagonal) {
    const auto cameras = brlcad_cameras({{-1.5, -1, -0.5}, {2.5, 3, 1}}, {});
    ASSERT_EQ(cameras.size(), 8u);
    const auto& camera = std::get<OrthographicCamera>(cameras[0].camera);
    // The box has integer corners: (-2, -1, -1) and (3, 3, 1).
    const double size = std::sqrt(25.0 + 16.0 + 4.0);
    EXPECT_NEAR(length(camera.right), size, 1e-12);
    EXPECT_NEAR(length(camera.up), size, 1e-12);
    EXPECT_NEAR(camera.direction.x, -0.7424038765, 1e-9);
    EXPECT_NEAR(camera.direction.y, -0.5198367907, 1e-9);
    EXPECT_NEAR(camera.direction.z, -0.4226182617, 1e-9);
    const Vec3 middle = camera.origin + (size / std::sqrt(2.0)) * camera.direction;
    EXPECT_NEAR(length(middle - Vec3{0.5, 1, 0}), 0, 1e-12);
}

TEST(BrlcadView, OrientationAndRotationSayTheSame) {
    // Orientation of azimuth 35, elevation 25, from the log of a reference image.
    const auto views = views_of(
        "#!/bin/sh\nrt -M <<EOF\nviewsize 157.2;\neye_pt 1 2 3;\n"
        "orientation 0.248097 0.476591 0.748097 0.389435;\nstart 4; clean;\nend;\n"
        "viewrot -0.5735764503 0.8191520572 0 0 -0.3461886346 -0.2424038798 0.9063078165 0\n"
        "0.7424039245 0.519836843 0.4226182699 0 0 0 0 1; set perspective=90;\n"
        "start 5;\nend;\nae 35 25; lookat_pt 1 2 1;\nEOF\n");
    ASSERT_EQ(views.size(), 3u);
    EXPECT_EQ(views[0].name, "frame 4");
    const auto& first = std::get<OrthographicCamera>(views[0].camera);
    const auto& second = std::get<PerspectiveCamera>(views[1].camera);
    EXPECT_NEAR(length(first.direction - second.look), 0, 3e-6);
    EXPECT_NEAR(length((1 / 157.2) * first.right - 0.5 * second.right), 0, 3e-6);
    EXPECT_NEAR(length((1 / 157.2) * first.up - 0.5 * second.up), 0, 3e-6);
    EXPECT_EQ(first.origin, (Vec3{1, 2, 3}));
    const auto& third = std::get<PerspectiveCamera>(views[2].camera);
    EXPECT_NEAR(length(third.look - Vec3{0, 0, -1}), 0, 1e-12);
}

TEST(BrlcadView, ALookAtPointTurnsTheProjectionOfTheXAxisToTheRight) {
    // mat_lookat of rt: the picture is upside down where that projection says so.
    const auto views = views_of(
        "viewsize 1; eye_pt 0 3 4; lookat_pt 0 0 0; start 0; end;"
        "eye_pt 0 -3 4; lookat_pt 0 0 0; start 1; end;"
        "eye_pt 0 3 4; lookat_pt 0 0 0 1; start 2; end;"
        "eye_pt 5 0 0; lookat_pt 0 0 0; start 3; end;"
        "eye_pt 0 0 5; lookat_pt 0 0 0; start 4; end;"
        "eye_pt 0 0 5; lookat_pt 0 0 5; start 5; end;");
    ASSERT_EQ(views.size(), 6u);
    expect_parallel(views[0], {0, -.6, -.8}, {1, 0, 0}, {0, .8, -.6});
    expect_parallel(views[1], {0, .6, -.8}, {1, 0, 0}, {0, .8, .6});
    expect_parallel(views[2], {0, -.6, -.8}, {1, 0, 0}, {0, -.8, .6});  // a reflection
    expect_parallel(views[3], {-1, 0, 0}, {0, 0, 1}, {0, -1, 0});
    expect_parallel(views[4], {0, 0, -1}, {1, 0, 0}, {0, 1, 0});
    expect_parallel(views[5], {-1, 0, 0}, {0, 1, 0}, {0, 0, 1});
}

TEST(BrlcadView, OfTheCommandsThatTurnTheViewTheLastCounts) {
    const auto views = views_of(
        "viewsize 1; eye_pt 0 3 4; lookat_pt 0 0 0; ae 90 0; start 0; end;"
        "lookat_pt 0 0 0; eye_pt 5 0 0; start 1; end; orientation .5 .5 .5 .5; start 2; end;");
    ASSERT_EQ(views.size(), 3u);
    expect_parallel(views[0], {0, -1, 0}, {-1, 0, 0}, {0, 0, 1});
    expect_parallel(views[1], {0, -.6, -.8}, {1, 0, 0}, {0, .8, -.6});  // of the eye at that time
    expect_parallel(views[2], {-1, 0, 0}, {0, 1, 0}, {0, 0, 1});
}

TEST(BrlcadView, EachHereDocumentIsARunOfItsOwnWithThePerspectiveOfItsCommand) {
    const std::string frame = "eye_pt 0 0 9;\norientation 0 0 0 1;\nstart 0; clean;\nend;\n\nEOF\n";
    const auto views =
        views_of("#!/bin/sh\nrt -M -p60 -s256\\\n $*\\\n 'a.g'\\\n <<EOF\nviewsize 4;\n" + frame +
                 "#!/bin/sh\nrt -M \\\n <<EOF\n" + frame);
    ASSERT_EQ(views.size(), 2u);
    EXPECT_EQ(views[0].name, "frame 0");
    EXPECT_EQ(views[1].name, "frame 0 of view 1");
    const auto& first = std::get<PerspectiveCamera>(views[0].camera);
    EXPECT_NEAR(length(first.right), 2 / std::sqrt(3.0), 1e-12);
    // The second has not the size of the first: that of the model.
    EXPECT_NEAR(length(std::get<OrthographicCamera>(views[1].camera).right), std::sqrt(12.0),
                1e-12);
}

TEST(BrlcadView, MarksOfHereDocumentsMayBeQuotedAndFollowedByWords) {
    for (const char* begin :
         {"<<EOF", "<<'EOF'", "<<-\"EOF\"", "<< EOF 2>log", "<<EOF\nEOF\nrt <<EOF"}) {
        const auto views =
            views_of("rt -p60 " + std::string(begin) + "\nae 1 2;\nEOF\necho done\n");
        ASSERT_EQ(views.size(), 1u) << begin;
    }
    const auto views = views_of(
        "rt <<EOF\nae 1 2; start 0; end; start 1; end;\nEOF\n"
        "rt <<EOF\nae 3 4; start 0; end; start 0; end;\nEOF\n");
    ASSERT_EQ(views.size(), 4u);
    EXPECT_EQ(views[2].name, "frame 0 of view 1");
    EXPECT_EQ(views[3].name, "frame 0 of view 1, camera 3");
}

TEST(BrlcadView, LinesAreCountedThroughHereDocuments) {
    Diagnostics found;
    (void)read_brlcad_views("rt <<EOF\nae 1 2;\nEOF\nrt <<EOF\nviewsize 0;\nEOF\n", "a.rt", kBox,
                            found);
    EXPECT_EQ(text_of(found), "a.rt:5:1: error: the size of a view must be positive\n");
}

TEST(BrlcadView, ASavedViewHasTheBackgroundOfItsCommand) {
    EXPECT_EQ(brlcad_view_background("#!/bin/sh\nrt -M -o a.pix -C0/0/51\\\n a.g <<EOF\nae 1 2;\n"),
              (Rgb{0, 0, 0.2}));
    EXPECT_EQ(brlcad_view_background("rt -C \"255 0 0\" a.g <<EOF\n"), (Rgb{1, 0, 0}));
    EXPECT_FALSE(brlcad_view_background("ae 35 25; -C0/0/50;").has_value());
    EXPECT_FALSE(brlcad_view_background("rt a.g <<EOF\nend;\nEOF\n").has_value());
}

TEST(BrlcadView, FaultsOfAScriptAreToldWithTheirLine) {
    const auto message = [&](const char* text) {
        Diagnostics found;
        (void)read_brlcad_views(text, "a.rt", kBox, found);
        return text_of(found);
    };
    EXPECT_NE(message("").find("no view in the script"), std::string::npos);
    EXPECT_NE(message("\nviewsize 0;").find("a.rt:2:1: error: the size"), std::string::npos);
    EXPECT_NE(message("ae 35;").find("expected 2 numbers"), std::string::npos);
    EXPECT_NE(message("orientation 0 0 0 0;").find("must not be zero"), std::string::npos);
    EXPECT_NE(message("viewsize nan;").find("found 'nan'"), std::string::npos);
    EXPECT_NE(message("set perspective=200; ae 1 2;").find("0 to 180"), std::string::npos);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
