/// RIB: requests, transforms and cameras, patches of every basis, trimmed surfaces, malformed
/// files.

#include <gtest/gtest.h>

#include <cmath>

#include "alhazen/base/file.h"
#include "alhazen/formats/patches/cubic_basis.h"
#include "alhazen/formats/rib/rib_importer.h"
#include "support/test_data.h"
#include "unit/formats/text_scene.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::shape_of;

testing::Imported import_rib(const std::string& text) {
    return testing::import_text<RibImporter>(text, "a.rib");
}

/// A bilinear patch with the corner (x, 0, 0).
std::string bilinear(int x) {
    const std::string a = std::to_string(x), b = std::to_string(x + 1);
    return "Patch \"bilinear\" \"P\" [" + a + " 0 0 " + b + " 0 0 " + a + " 1 0 " + b + " 1 0]\n";
}

TEST(Rib, PatchesOfOneTransformAreOneMeshAndUComesFirst) {
    const auto read = import_rib("WorldBegin\n" + bilinear(0) + "AttributeBegin " + bilinear(1) +
                                 "AttributeEnd TransformBegin Translate 0 0 1 " + bilinear(0) +
                                 "TransformEnd " + bilinear(2) + "WorldEnd");
    EXPECT_EQ(read.messages(), "");
    ASSERT_EQ(read.parts().size(), 2u);
    const auto& mesh = shape_of<PatchMesh>(read);
    EXPECT_EQ(mesh.patch_count(), 3u);
    EXPECT_EQ(mesh.points.size(), 8u);
    EXPECT_EQ(mesh.degree_u, 1u);
    // du points along x.
    const BezierNet net = mesh.net(0);
    EXPECT_EQ(projected(net.at(1, 0)) - projected(net.at(0, 0)), (Vec3{1, 0, 0}));
    EXPECT_EQ(read.parts()[1].object_from_part.translation, (Vec3{0, 0, 1}));
}

TEST(Rib, TheTransformBeforeTheWorldIsTheCamera) {
    const auto read = import_rib(
        "Format 200 100 1 Projection \"perspective\" \"fov\" 90 Translate 0 0 5 Rotate 90 0 1 0\n"
        "WorldBegin " +
        bilinear(0) + "WorldEnd");
    EXPECT_EQ(read.messages(), "");
    EXPECT_EQ(read.scene.picture.width, 200);
    ASSERT_EQ(read.scene.cameras.size(), 1u);
    const auto& camera = std::get<PerspectiveCamera>(read.scene.cameras[0].camera);
    // x of the world is -z of the camera: the eye is at +5 x and looks along -x.
    EXPECT_NEAR(length(camera.eye - Vec3{5, 0, 0}), 0, 1e-12);
    EXPECT_NEAR(length(camera.look - Vec3{-1, 0, 0}), 0, 1e-12);
    EXPECT_NEAR(length(camera.right), 4, 1e-12);
    EXPECT_NEAR(length(camera.up - Vec3{0, 2, 0}), 0, 1e-12);
    EXPECT_EQ(read.scene.cameras[0].aspect, 2);
    EXPECT_TRUE(read.parts()[0].object_from_part == Affine{});
}

/// The point of sum_k N_k(t) P_k for a basis matrix of rows t^3, t^2, t, 1.
Vec3 on_curve(const std::array<double, 16>& m, const std::array<Vec3, 4>& p, double t) {
    Vec3 sum{};
    const double power[4] = {t * t * t, t * t, t, 1};
    for (std::size_t k = 0; k < 16; ++k) sum = sum + power[k / 4] * m[k] * p[k % 4];
    return sum;
}

TEST(Rib, EveryBasisIsTheSameCurveAsItsMatrix) {
    const std::vector<std::pair<const char*, std::array<double, 16>>> bases{
        {"bezier", {-1, 3, -3, 1, 3, -6, 3, 0, -3, 3, 0, 0, 1, 0, 0, 0}},
        {"b-spline",
         {-1 / 6., .5, -.5, 1 / 6., .5, -1, .5, 0, -.5, 0, .5, 0, 1 / 6., 4 / 6., 1 / 6., 0}},
        {"catmull-rom", {-.5, 1.5, -1.5, .5, 1, -2.5, 2, -.5, -.5, 0, .5, 0, 0, 1, 0, 0}},
        {"hermite", {2, 1, -2, 1, -3, -2, 3, -1, 0, 1, 0, 0, 1, 0, 0, 0}},
        {"power", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}}};
    const std::array<Vec3, 4> p{Vec3{1, 2, 3}, {2, -1, 0}, {4, 1, 1}, {5, 5, -2}};
    std::array<HomogeneousPoint, 4> points;
    for (std::size_t k = 0; k < 4; ++k) points[k] = {p[k].x, p[k].y, p[k].z, 1};
    for (const auto& [name, matrix] : bases) {
        for (const CubicBasis& basis : {*CubicBasis::named(name), CubicBasis(matrix)}) {
            const auto b = basis.bezier(points);
            for (const double t : {0.0, 0.3, 1.0}) {
                const double s = 1 - t;
                const HomogeneousPoint q = s * s * s * b[0] + 3 * s * s * t * b[1] +
                                           3 * s * t * t * b[2] + t * t * t * b[3];
                EXPECT_NEAR(length(Vec3{q.x, q.y, q.z} - on_curve(matrix, p, t)), 0, 1e-13)
                    << name << " " << t;
            }
        }
    }
    EXPECT_FALSE(CubicBasis::named("beta"));
}

TEST(Rib, PatchesOfPointsWithoutWeightsAreNotRationalInAnyBasis) {
    // x = u, y = v: coefficients of powers, then end points and tangents.
    const auto power = import_rib(
        "Basis \"power\" 1 \"power\" 1 Patch \"bicubic\" \"P\" [0 0 0 0 0 0 0 0 0 0 0 0  0 0 0 0 0 "
        "0 0 0 0 "
        "0 0 0  0 0 0 0 0 0 0 0 0 0 1 0  0 0 0 0 0 0 1 0 0 0 0 0]");
    const auto hermite = import_rib(
        "Basis \"hermite\" 1 \"hermite\" 1 Patch \"bicubic\" \"P\" [0 0 0 1 0 0 1 0 0 1 0 0  0 1 0 "
        "0 0 0 0 "
        "1 0 0 0 0  0 1 0 1 0 0 1 1 0 1 0 0  0 1 0 0 0 0 0 1 0 0 0 0]");
    EXPECT_EQ(power.messages(), "");
    EXPECT_EQ(hermite.messages(), "");
    const auto& p = shape_of<PatchMesh>(power);
    EXPECT_TRUE(p.weights.empty());
    const BezierNet net = p.net(0);
    for (int i = 0; i < 4; ++i) {
        for (int j = 0; j < 4; ++j) {
            EXPECT_NEAR(length(projected(net.at(i, j)) - Vec3{i / 3., j / 3., 0}), 0, 1e-15);
        }
    }
    const auto& h = shape_of<PatchMesh>(hermite);
    EXPECT_TRUE(h.weights.empty());
    EXPECT_EQ(projected(h.net(0).at(3, 0)), (Vec3{1, 0, 0}));
}

TEST(Rib, TheScreenWindowFillsThePictureWhateverTheShapeOfItsPixels) {
    const auto camera = [](const std::string& format) {
        const auto read = import_rib(format + " Projection \"orthographic\" WorldBegin " +
                                     bilinear(0) + "WorldEnd");
        EXPECT_EQ(read.messages(), "");
        const CameraDescription& one = read.scene.cameras.at(0);
        EXPECT_EQ(one.aspect, double(*read.scene.picture.width) / *read.scene.picture.height);
        const auto& view = std::get<OrthographicCamera>(one.camera);
        return std::array<double, 4>{double(*read.scene.picture.width),
                                     double(*read.scene.picture.height), length(view.right),
                                     length(view.up)};
    };
    using Camera = std::array<double, 4>;
    EXPECT_EQ(camera("Format 80 40 0.5 ScreenWindow -3 1 -2 2"), (Camera{80, 40, 4, 4}));
    EXPECT_EQ(camera("Format 80 40 0.5"), (Camera{80, 40, 2, 2}));
    EXPECT_EQ(camera("Format 64 64 1 FrameAspectRatio 2"), (Camera{64, 32, 4, 2}));
    EXPECT_EQ(camera("Format 64 64 1 FrameAspectRatio 0.5"), (Camera{32, 64, 2, 4}));
    const auto aspect = import_rib(
        "FrameAspectRatio 3 ScreenWindow -1 1 -1 1 Projection \"orthographic\" WorldBegin " +
        bilinear(0) + "WorldEnd");
    EXPECT_EQ(aspect.scene.cameras.at(0).aspect, 3);
}

TEST(Rib, MeshesOfPatchesShareTheirBoundariesBitForBit) {
    // A torus of b-splines: closed when neighbours have equal boundary points.
    for (const char* basis : {"b-spline", "catmull-rom"}) {
        std::string text = std::string("Basis \"") + basis + "\" 1 \"" + basis + "\" 1\n" +
                           "PatchMesh \"bicubic\" 7 \"periodic\" 5 \"periodic\" \"P\" [";
        for (int v = 0; v < 5; ++v) {
            for (int u = 0; u < 7; ++u) {
                const double a = u * 0.8975979, b = v * 1.2566371, r = 3 + std::cos(b);
                text += std::to_string(r * std::cos(a)) + " " + std::to_string(r * std::sin(a)) +
                        " " + std::to_string(std::sin(b)) + "\n";
            }
        }
        auto read = import_rib(text + "]");
        EXPECT_EQ(read.messages(), "");
        auto mesh = shape_of<PatchMesh>(read);
        EXPECT_EQ(mesh.patch_count(), 35u);
        mesh.prepare();
        EXPECT_TRUE(mesh.closed()) << basis;
    }
}

TEST(Rib, SurfacesKeepWhatIsOutsideOfTheirTrimCurves) {
    const std::string surface =
        "NuPatch 2 2 [0 0 1 1] 0 1 3 2 [0 0 1 2 2] 0 2 \"Pw\" [0 0 0 1 1 0 0 1  0 2 0 2 2 2 0 2\n"
        "0 2 0 1 1 2 0 1]\n";
    const std::string trim =
        "TrimCurve [1] [2] [0 0 1 2 3 3] [0] [3] [4] [.2 .8 .5 .2] [.2 .2 .8 .2] [1 1 1 1]\n";
    const auto plain = import_rib(surface);
    EXPECT_EQ(plain.messages(), "");
    const auto& whole = shape_of<NurbsSurface>(plain);
    EXPECT_EQ(whole.degree_v, 1u);
    EXPECT_EQ(whole.points[1], (Vec3{0, 1, 0}));
    EXPECT_EQ(whole.weights, (std::vector<double>{1, 2, 1, 1, 2, 1}));
    EXPECT_TRUE(whole.trims.empty());
    const auto cut = import_rib(trim + surface);
    EXPECT_EQ(cut.messages(), "");
    EXPECT_EQ(shape_of<NurbsSurface>(cut).trims.size(), 2u);
    EXPECT_EQ(shape_of<NurbsSurface>(cut).trims[1][0].points[2], (Vec2{0.5, 0.8}));
    // The same triangle as a part of a curve with a further point.
    const auto part = import_rib(
        "TrimCurve [1] [2] [0 0 1 2 3 4 4] [0] [3] [5] [.2 .8 .5 .2 9] [.2 .2 .8 .2 9] [1 1 1 1 "
        "1]\n" +
        surface);
    EXPECT_EQ(part.messages(), "");
    EXPECT_EQ(shape_of<NurbsSurface>(part).trims[1][0].points,
              shape_of<NurbsSurface>(cut).trims[1][0].points);
    const auto kept =
        import_rib("Attribute \"trimcurve\" \"sense\" \"outside\"\n" + trim + surface);
    EXPECT_EQ(shape_of<NurbsSurface>(kept).trims.size(), 1u);
}

TEST(Rib, QuadricsObjectsAndColours) {
    const auto read = import_rib(
        "ObjectBegin 3 Color [1 0 0] Sphere 2 -2 2 360 Cylinder 1 0 3 360 ObjectEnd\n"
        "Scale 2 2 2 ObjectInstance 3 Translate 1 0 0 ObjectInstance 3\n"
        "Torus 3 1 0 360 360 Cone 2 1 360 Disk 1 1 360 Paraboloid 1 0 2 360 Sphere 2 -1 2 360\n");
    EXPECT_EQ(read.errors(), 0u) << read.messages();
    EXPECT_TRUE(read.says("a.rib:3:68: warning: geometry left out: 1 partial Sphere"))
        << read.messages();
    ASSERT_EQ(read.scene.objects.size(), 2u);
    EXPECT_EQ(read.scene.objects[1].parts.size(), 2u);
    EXPECT_EQ(read.parts().size(), 6u);
    EXPECT_EQ(read.parts()[1].object_from_part.translation, (Vec3{2, 0, 0}));
    EXPECT_EQ(read.scene.materials.at(0).material.diffuse.color.g, 0);
}

TEST(Rib, NumbersOfQuadricsMayBeOneArray) {
    const auto read = import_rib(
        "Sphere [2 -2 2 360] Cylinder [1 0 3 360] Torus [3 1 0 360 360] Cone [2 1 360]\n"
        "Disk [1 1 360] Paraboloid [1 0 2 360] Sphere [1 -1 1 360] \"Cs\" [1 0 0]\n");
    EXPECT_EQ(read.messages(), "");
    ASSERT_EQ(read.parts().size(), 7u);
    EXPECT_EQ(shape_of<Sphere>(read).radius, 2);
}

TEST(Rib, GeometryLeftOutIsCountedAndAWrongCountIsAnError) {
    const auto read =
        import_rib(bilinear(0) +
                   "Sphere 1 -1 0 360 Sphere 1 -1 1 180 Polygon \"P\" [0 0 0 1 0 0 0 1 0]\n"
                   "ReadArchive \"b.rib\" Disk 0 0 360 Cone 1 0 360 Shpere 1 2\n");
    EXPECT_EQ(
        read.messages(),
        "a.rib:3:47: warning: ignored: Shpere\n"
        "a.rib:2:1: warning: geometry left out: 1 Cone without extent, 1 Disk without extent, "
        "1 Polygon, 1 ReadArchive, 2 partial Sphere\n");
    EXPECT_TRUE(
        import_rib("Sphere 1 -1 1").says("a.rib:1:1: error: Sphere: expected 4 numbers, found 3"));
    // By its equations a cone of height 0 is a disc.
    EXPECT_EQ(shape_of<Disc>(import_rib("Cone 0 2 360")).radius, 2);
}

TEST(Rib, InstancesInheritTheColourThatTheObjectDoesNotSet) {
    const auto read = import_rib(
        "Color [0 0 1] ObjectBegin 1 Sphere 1 -1 1 360 Color [0 1 0] Sphere 1 -1 1 360 ObjectEnd\n"
        "ObjectBegin 2 ObjectInstance 1 ObjectEnd\n"
        "Color [1 0 0] ObjectInstance 2 ObjectInstance 1 Color [0 0 1] ObjectInstance 1\n");
    EXPECT_EQ(read.messages(), "");
    const auto color_of = [&](const Part& part) {
        return read.scene.materials.at(std::size_t(part.material)).material.diffuse.color;
    };
    const auto object_of = [&](const Part& part) -> const ObjectDescription& {
        return read.scene.objects.at(std::size_t(std::get<ObjectIndex>(part.what)));
    };
    ASSERT_EQ(read.parts().size(), 3u);
    const ObjectDescription& nested = object_of(object_of(read.parts()[0]).parts.at(0));
    const ObjectDescription& red = object_of(read.parts()[1]);
    const ObjectDescription& blue = object_of(read.parts()[2]);
    EXPECT_EQ(&nested, &red);
    // An instance within an object keeps the colour that the object sets for it.
    const auto own = import_rib(
        "ObjectBegin 1 Sphere 1 -1 1 360 ObjectEnd\n"
        "ObjectBegin 2 Sphere 1 -1 1 360 Color [0 1 0] ObjectInstance 1 ObjectEnd\n"
        "Color [1 0 0] ObjectInstance 2\n");
    const auto part_of = [&](std::size_t object, std::size_t k) -> const Part& {
        return own.scene.objects.at(object).parts.at(k);
    };
    const auto shown = std::size_t(std::get<ObjectIndex>(own.parts().at(0).what));
    const auto inner = std::size_t(std::get<ObjectIndex>(part_of(shown, 1).what));
    EXPECT_EQ(
        own.scene.materials.at(std::size_t(part_of(inner, 0).material)).material.diffuse.color,
        (Rgb{0, 1, 0}));
    EXPECT_EQ(color_of(red.parts.at(0)), (Rgb{1, 0, 0}));
    EXPECT_EQ(color_of(red.parts.at(1)), (Rgb{0, 1, 0}));
    EXPECT_EQ(color_of(blue.parts.at(0)), (Rgb{0, 0, 1}));
}

TEST(Rib, SkewTurnsTheFirstAxisTowardsTheSecond) {
    const auto skewed = [](const std::string& numbers, const Vec3& p) {
        const auto read = import_rib("WorldBegin Skew " + numbers + " " + bilinear(0) + "WorldEnd");
        EXPECT_EQ(read.messages(), "");
        return read.parts().at(0).object_from_part.point(p);
    };
    const auto expect = [](const Vec3& found, const Vec3& wanted) {
        EXPECT_LT(length(found - wanted), 1e-12);
    };
    expect(skewed("45 0 1 0 1 0 0", {0, 2, 3}), {2, 2, 3});
    expect(skewed("[-45 0 3 0 0.5 0 0]", {1, 2, 3}), {-1, 2, 3});
    // Axes at 60 degrees: y turns by 30 degrees, and points move along the other alone.
    const double c = std::sqrt(0.75);
    const Vec3 along{c, 0.5, 0}, turned{0.5, c, 0};
    const Vec3 image = skewed("30 0 1 0 0.86602540378443864676 0.5 0", {0, 1, 0});
    expect(image / length(image), turned);
    EXPECT_NEAR(length(cross(image - Vec3{0, 1, 0}, along)), 0, 1e-12);
    expect(skewed("30 0 1 0 0.86602540378443864676 0.5 0", along), along);
    expect(skewed("30 0 1 0 0.86602540378443864676 0.5 0", {0, 0, 5}), {0, 0, 5});
    for (const char* bad :
         {"90 0 1 0 1 0 0", "-90 0 1 0 1 0 0", "10 0 1 0 0 -2 0", "10 0 0 0 1 0 0"}) {
        EXPECT_EQ(import_rib("WorldBegin Skew " + std::string(bad) + " " + bilinear(0) + "WorldEnd")
                      .errors(),
                  1u)
            << bad;
    }
}

TEST(Rib, IdentityBeforeTheWorldIsTheCamerasOwn) {
    const auto read = import_rib(
        "Projection \"perspective\" Translate 0 0 5 Identity Translate 0 0 3 WorldBegin\n" +
        bilinear(0) + "WorldEnd");
    const auto& camera = std::get<PerspectiveCamera>(read.scene.cameras.at(0).camera);
    EXPECT_NEAR(length(camera.eye - Vec3{0, 0, -3}), 0, 1e-12);
}

TEST(Rib, WhatIsIgnoredIsListedOnce) {
    const auto read = import_rib("Declare \"a\" \"float\"\nSurface \"plastic\" \"Kd\" .5\n" +
                                 bilinear(0) + "Surface \"matte\"\nLightSource \"x\" 1\n");
    EXPECT_EQ(read.messages(), "a.rib:1:1: warning: ignored: Declare, Surface, LightSource\n");
}

TEST(Rib, EveryFindingHasItsPlace) {
    const std::vector<std::pair<std::string, std::string>> cases{
        {"Patch \"bicubic\" \"P\" [0 0 0]", "a.rib:1:1: error: Patch has 1 points; expected 16"},
        {"\n Patch \"cubic\" \"P\" [0 0 0]", "a.rib:2:2: error: Patch: expected \"bicubic\""},
        {"Patch \"bilinear\" \"P\" [0 0 0 1]", "a.rib:1:22: error: \"P\" has 4 numbers"},
        {"Patch \"bilinear\" \"st\" [0 0]", "expected \"P\" or \"Pw\""},
        {"Patch \"bilinear\" \"P\" [0 nan 0]", "a.rib:1:25: error: expected a number, a string"},
        {"Patch \"bilinear\" \"P\" [0 1e999 0]", "a.rib:1:25: error: expected a finite number"},
        {"Patch \"bilinear\" \"P\" [0 0 0", "a.rib:1:22: error: the array that begins here"},
        {"Patch \"bilinear", "a.rib:1:7: error: the string that begins here has no end"},
        {"Patch \"bilinear\" \"Pw\" [0 0 0 1 1 0 0 1 0 1 0 0 1 1 0 1]", "weights of a patch"},
        {"PatchMesh \"bicubic\" 5 \"nonperiodic\" 4 \"nonperiodic\" \"P\" [0]",
         "a.rib:1:21: error: PatchMesh: 5 points with the step 3 make no whole number"},
        {"PatchMesh \"bicubic\" 100000000 \"periodic\" 99999999 \"periodic\" \"P\" [0 0 0]",
         "make no whole number"},
        {"PatchMesh \"bilinear\" 100000000 \"periodic\" 99999999 \"periodic\" \"P\" [0 0 0]",
         "has 1 points; expected 9999999900000000"},
        {"NuPatch 2 41 [0 1] 0 1 2 2 [0 0 1 1] 0 1 \"P\" [0]",
         "a.rib:1:11: error: NuPatch: the order must be a whole number from 2 to 8"},
        {"NuPatch 2 2 [0 1 0 1] 0 1 2 2 [0 0 1 1] 0 1 \"P\" [0]",
         "a.rib:1:13: error: knot 2 falls below"},
        {"NuPatch 2 2 [0 0 1] 0 1 2 2 [0 0 1 1] 0 1 \"P\" [0]", "expected 4 knots"},
        {"TrimCurve [1] [2] [0 0 1 1] [0] [1] [2] [0 0] [0 0] [1 0]",
         "a.rib:1:1: error: TrimCurve: curve 1: weights must be positive"},
        {"TrimCurve [1] [2] [0 0 1 1] [0] [1.5] [2] [0 0] [0 0] [1 1]", "must be within that"},
        {"TrimCurve [9e9] [2] [0 0 1 1] [0] [1] [2] [0 0] [0 0] [1 1]", "curve 2: there are fewer"},
        {"AttributeBegin WorldEnd", "a.rib:1:16: error: WorldEnd: the open block is Attribute"},
        {"WorldEnd", "WorldEnd: no block is open"},
        {"\nWorldBegin", "a.rib:2:1: error: WorldBegin has no end"},
        {"Scale 0 1 1", "a.rib:1:1: error: Scale: the transform has no inverse"},
        {"Rotate 5 0 0 0", "Rotate: the axis is zero"},
        {"Transform [1 0 0 1 0 1 0 0 0 0 1 0 0 0 0 1]", "Transform: the matrix is not affine"},
        {"Basis \"beta\" 1 \"bezier\" 3", "Basis: expected for u and v"},
        {"ObjectInstance 4", "ObjectInstance: there is no such object"},
        {"Projection \"fisheye\"", "Projection: expected"},
        {"version 3 \x85\x01", "a.rib:1:11: error: "},
        {"\x85", "binary encoding"},
    };
    for (const auto& [text, finding] : cases) {
        const auto read = import_rib(text);
        EXPECT_GT(read.errors(), 0u) << text;
        EXPECT_TRUE(read.says(finding)) << finding << "\n" << read.messages();
    }
}

TEST(Rib, NestingAndErrorsAreBounded) {
    std::string deep;
    for (int i = 0; i < 20'000; ++i) deep += "AttributeBegin ";
    EXPECT_THROW((void)import_rib(deep), Error);
    std::string bad;
    for (int i = 0; i < 5'000; ++i) bad += "Scale 0 0 0\n";
    EXPECT_LT(import_rib(bad).errors(), 60u);
}

TEST(Rib, TheUtahTeapotIsReadWhole) {
    ALHAZEN_NEEDS_DATA("patches/uteapot.rib");
    const auto path = testing::test_data() / "patches/uteapot.rib";
    const auto read = testing::import_text<RibImporter>(read_file(path), path);
    EXPECT_EQ(read.errors(), 0u) << read.messages();
    EXPECT_EQ(read.diagnostics.warning_count(), 1u) << read.messages();
    ASSERT_EQ(read.parts().size(), 1u);
    const auto& mesh = shape_of<PatchMesh>(read);
    EXPECT_EQ(mesh.patch_count(), 32u);
    EXPECT_EQ(read.scene.cameras.size(), 1u);
    EXPECT_EQ(read.scene.picture.width, 800);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
