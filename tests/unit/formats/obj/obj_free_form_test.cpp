/// Free-form surfaces of OBJ: bases, weights, trimming loops, groups, malformed statements.

#include <gtest/gtest.h>

#include <cmath>

#include "alhazen/formats/obj/obj_importer.h"
#include "alhazen/formats/obj/obj_surfaces.h"
#include "alhazen/shapes/patches/nurbs/trim_curve_part.h"
#include "unit/formats/text_scene.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::shape_of;

testing::Imported import_obj(const std::string& text) {
    return testing::import_text<ObjImporter>(text, "a.obj");
}

const std::string kPatchCorners = "v 0 0 0\nv 1 0 0 2\nv 0 1 0\nv 1 1 1\n";
const std::string kPatch =
    "cstype bezier\ndeg 1 1\nsurf 0 1 0 1 1/1/1 2//2 -2 -1\nparm u 0 1\nparm v 0 1\nend\n";

TEST(ObjFreeForm, BezierSurfacesOfAGroupAreOnePatchMesh) {
    const auto read = import_obj(
        kPatchCorners + "v 2 0 0\nv 2 1 0\ng a\nusemtl red\n" + kPatch +
        "cstype rat bezier\ndeg 1 1\nsurf 0 2 0 1 1 2 5 3 4 6\nparm u 0 1 2\nparm v 0 1\nend\n"
        "f 1 2 3\ng b\nusemtl blue\ncstype bezier\ndeg 1 1\nsurf 0 1 0 1 1 2 3 4\nend\n");
    EXPECT_EQ(read.errors(), 0u) << read.messages();
    ASSERT_EQ(read.parts().size(), 3u);
    EXPECT_TRUE(std::holds_alternative<MeshIndex>(read.parts()[0].what));
    const auto& mesh = shape_of<PatchMesh>(read, 1);
    EXPECT_EQ(read.parts()[1].name, "a");
    EXPECT_EQ(read.parts()[1].location.line, 11);
    ASSERT_EQ(mesh.patch_count(), 3u);
    // u varies fastest in the file: the second control point is at v = 1.
    EXPECT_EQ(projected(mesh.net(0).at(1, 0)), (Vec3{1, 0, 0}));
    EXPECT_EQ(mesh.net(0).at(1, 0).w, 1.0);
    EXPECT_EQ(mesh.net(1).at(1, 0).w, 2.0);
    EXPECT_EQ(projected(mesh.net(2).at(1, 1)), (Vec3{2, 1, 0}));
    EXPECT_EQ(read.parts()[2].name, "b");
}

TEST(ObjFreeForm, SplinesKeepTheirKnotsAndWeights) {
    const auto read =
        import_obj(kPatchCorners +
                   "v 2 0 0 1\nv 2 1 0\ncstype rat bspline\ndeg 2 1\nsurf 0 1 0 1 1 2 5 3 4 6\n"
                   "parm u 0 0 0 \\\n 1 1 1\nparm v 0 0 1 1\nend\n");
    EXPECT_EQ(read.messages(), "");
    const auto& s = shape_of<NurbsSurface>(read);
    EXPECT_EQ(s.knots_u, (std::vector<double>{0, 0, 0, 1, 1, 1}));
    EXPECT_EQ(s.points[2], (Vec3{1, 0, 0}));
    EXPECT_EQ(s.weights, (std::vector<double>{1, 1, 2, 1, 1, 1}));
    EXPECT_TRUE(s.trims.empty());
}

TEST(ObjFreeForm, CardinalSurfacesBecomeBezierPatches) {
    std::string text;
    for (int v = 0; v < 4; ++v) {
        for (int u = 0; u < 5; ++u) {
            text += "v " + std::to_string(u) + " " + std::to_string(v) + " 0\n";
        }
    }
    text += "cstype cardinal\ndeg 3 3\nsurf 0 2 0 1";
    for (int k = 1; k <= 20; ++k) text += " " + std::to_string(k);
    const auto read = import_obj(text + "\nparm u 0 1 2\nparm v 0 1\nend\n");
    EXPECT_EQ(read.messages(), "");
    const auto& mesh = shape_of<PatchMesh>(read);
    ASSERT_EQ(mesh.patch_count(), 2u);
    // From the second point to the last but one.
    EXPECT_NEAR(length(point_at(mesh.net(0), 0, 0) - Vec3{1, 1, 0}), 0, 1e-15);
    EXPECT_NEAR(length(point_at(mesh.net(1), 1, 1) - Vec3{3, 2, 0}), 0, 1e-15);
    EXPECT_NEAR(length(point_at(mesh.net(1), 0.5, 0.5) - Vec3{2.5, 1.5, 0}), 0, 1e-15);
}

const std::string kHole =
    "vp 0.2 0.2\nvp 0.8 0.2\nvp 0.5 0.8\nvp 0.2 0.2\ncstype bezier\ndeg 1\n"
    "curv2 -4 -3 -2 -1\nparm u 0 1 2 3\nend\n";

TEST(ObjFreeForm, LoopsTrimTheSurface) {
    const auto read = import_obj(kPatchCorners + kHole +
                                 "deg 1 1\nsurf 0 1 0 1 1 2 3 4\nparm u 0 1\nparm v 0 1\n"
                                 "hole 0 2 -1 2 3 1\nend\n");
    EXPECT_EQ(read.messages(), "");
    const auto& s = shape_of<NurbsSurface>(read);
    ASSERT_EQ(s.trims.size(), 2u) << "the whole domain, and the hole";
    EXPECT_EQ(s.trims[0][0].points.size(), 5u);
    ASSERT_EQ(s.trims[1].size(), 2u);
    EXPECT_EQ(s.trims[1][0].points.back(), (Vec2{0.5, 0.8}));
    EXPECT_EQ(s.trims[1][1].points.front(), (Vec2{0.5, 0.8}));
    EXPECT_EQ(s.trims[1][1].points.size(), 2u);
    const auto kept =
        import_obj(kPatchCorners + kHole + "deg 1 1\nsurf 0 1 0 1 1 2 3 4\ntrim 0 3 1\nend\n");
    EXPECT_EQ(shape_of<NurbsSurface>(kept).trims.size(), 1u);
}

/// De Boor in homogeneous coordinates.
Vec2 on_trim(const TrimCurve& c, double t) {
    const std::size_t p = c.degree;
    std::size_t k = p;
    while (k + 1 < c.points.size() && c.knots[k + 1] <= t) ++k;
    std::vector<Vec3> d;
    for (std::size_t i = k - p; i <= k; ++i) {
        const double w = c.weights.empty() ? 1 : c.weights[i];
        d.push_back({w * c.points[i].x, w * c.points[i].y, w});
    }
    for (std::size_t r = 1; r <= p; ++r) {
        for (std::size_t j = p; j >= r; --j) {
            const double lo = c.knots[j + k - p], hi = c.knots[j + 1 + k - r];
            const double a = (t - lo) / (hi - lo);
            d[j] = (1 - a) * d[j - 1] + a * d[j];
        }
    }
    return {d[p].x / d[p].z, d[p].y / d[p].z};
}

TEST(ObjFreeForm, APartOfACurveIsThatPart) {
    const TrimCurve curve{.degree = 3,
                          .knots = {0, 0, 1, 2, 3, 3, 5, 6, 7, 7},
                          .points = {{0, 0}, {1, 2}, {3, 1}, {4, 4}, {6, 0}, {7, 3}},
                          .weights = {1, 2, 0.5, 1, 3, 1}};
    for (const auto& [from, to] : {std::pair{2.0, 5.0}, {2.5, 4.5}, {3.0, 3.5}, {4.5, 2.25}}) {
        const TrimCurve part = trim_curve_part(curve, from, to);
        ASSERT_EQ(part.knots.size(), part.points.size() + 4);
        const double lo = std::min(from, to), hi = std::max(from, to);
        for (const double x : {0.0, 0.25, 0.7, 1.0}) {
            const Vec2 a = on_trim(part, lo + x * (hi - lo)),
                       b = on_trim(curve, from + x * (to - from));
            EXPECT_NEAR(a.x, b.x, 1e-12) << from << " " << to << " " << x;
            EXPECT_NEAR(a.y, b.y, 1e-12) << from << " " << to << " " << x;
        }
    }
}

TEST(ObjFreeForm, WhatIsSkippedIsTold) {
    const auto read = import_obj(kPatchCorners + kPatch +
                                 "cstype taylor\ndeg 2 2\nsurf 0 1 0 1 1 2\nparm u 1 2\nend\n"
                                 "surf 0 1 0 1 1 2\nend\n"
                                 "cstype bezier\ndeg 1 1\ncurv 0 1 1 2\nparm u 0 1\nend\n"
                                 "surf 0 1 0 1 1 2 3 4\nsp 1\nscrv 0 1 1\nend\nstech cparma 1 1\n");
    EXPECT_EQ(read.errors(), 0u) << read.messages();
    EXPECT_EQ(read.diagnostics.warning_count(), 3u) << read.messages();
    EXPECT_TRUE(read.says("type taylor are skipped")) << read.messages();
    EXPECT_EQ(shape_of<PatchMesh>(read).patch_count(), 2u);
}

TEST(ObjFreeForm, EveryFindingHasItsPlace) {
    const std::string surf = "cstype bspline\ndeg 1 1\n";
    const std::vector<std::pair<std::string, std::string>> cases{
        {"cstype bezier\ndeg 40 1\nsurf 0 1 0 1 1 2 3 4\nend\n",
         "a.obj:7:1: error: degrees of surfaces are from 1 to 7, not 40"},
        {"cstype bezier\ndeg 1 1\nsurf 0 1 0 1 1 2 3\nend\n",
         "a.obj:7:1: error: the surface has 3 points; its degrees and parameters require 2 by 2"},
        {surf + "surf 0 1 0 1 1 2 3 4\nparm u 0 0 1 1\nend\n", "too few parameters"},
        {surf + "surf 0 1 0 1 1 2 3 4\nparm u 0 1 0 1\nend\n",
         "a.obj:8:13: error: the parameter falls below"},
        {surf + "surf 0 1 0 1 1 2 3 nan\nend\n", "a.obj:7:20: error: expected the number"},
        {surf + "surf 0 1 0 1 1 2 3 0\nend\n", "a.obj:7:20: error: expected the number"},
        {surf + "surf 0 1 0 1 1 2 3 -9\nend\n", "a.obj:7:20: error: expected the number"},
        {"cstype bezier\ndeg 1 1\nsurf 0 1 0 1 1 2 3 9\nend\n", "names the point 9"},
        {surf + "surf 0 inf 0 1 1 2 3 4\nend\n", "a.obj:7:8: error: expected a bound"},
        {"cstype bezier\ndeg 1 1\nsurf 1 0 0 1 1 2 3 4\nend\n", "must rise"},
        {"cstype bezier\ndeg 1 1\nsurf 0 2 0 1 1 2 3 4\nparm u 0 1\nend\n", "within its knots"},
        {"cstype bezier\ndeg 1 1\nsurf 0 1 0 1 1 2 3 4\ntrim 0 1 1\nend\n",
         "names the curve 1, and there are 0"},
        {kHole + "deg 1 1\nsurf 0 1 0 1 1 2 3 4\ntrim 0 4 1\nend\n", "beyond its parameters"},
        {kHole + "deg 1 1\nsurf 0 1 0 1 1 2 3 4\ntrim 0 1\nend\n",
         "expected the number of a curve"},
        {"v 0 0 1 0\ncstype rat bezier\ndeg 1 1\nsurf 0 1 0 1 1 2 3 5\nend\n",
         "the weight of the point 5 is not positive"},
        {surf + "surf 0 1 0 1 1 2 3 4\n", "has no end"},
        {"end\n", "a.obj:5:1: error: end without"},
        {"parm u 0 1\n", "outside of a surface"},
        {"cstype ratty\n", "expected bezier"},
        {"deg x\n", "a.obj:5:5: error: expected a degree"},
        {"vp\n", "expected a coordinate"},
    };
    for (const auto& [text, finding] : cases) {
        const auto read = import_obj(kPatchCorners + text);
        EXPECT_GT(read.errors(), 0u) << text;
        EXPECT_TRUE(read.says(finding)) << finding << "\n" << read.messages();
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
