// Triangles of shapes: within the tolerance, closed where the shape is, refused by name.

#include "alhazen/shapes/shape_tessellation.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <set>

#include "alhazen/math/constants.h"
#include "alhazen/shapes/meshes/mesh_edges.h"
#include "alhazen/shapes/patches/forms/exact_forms.h"
#include "alhazen/shapes/tessellation/patch_tessellation.h"
#include "support/odd_even_area.h"
#include "support/random_patches.h"
#include "support/random_shapes.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::Random;
using testing::RandomShape;

constexpr std::uint64_t kLimit = 500'000;

/// Largest distance of points of the triangles from the patch at the same parameters, which is not
/// less than that from the patch.
double largest_distance(const BezierPiece& piece, const TriangleMesh& mesh, Random& random) {
    double most = 0.0;
    for (const auto& t : mesh.triangles) {
        for (int i = 0; i < 3; ++i) {
            double a = random.uniform(), b = random.uniform();
            if (a + b > 1.0) a = 1.0 - a, b = 1.0 - b;
            const double c = 1.0 - a - b;
            const auto mean = [&](const auto& values) {
                return a * values[t[0]] + b * values[t[1]] + c * values[t[2]];
            };
            const Vec2 uv = mean(mesh.uvs);
            const auto within = [](double x, double lo, double hi) {
                return std::clamp((x - lo) / (hi - lo), 0.0, 1.0);
            };
            const Vec3 exact = point_at(piece.net, within(uv.x, piece.lo.x, piece.hi.x),
                                        within(uv.y, piece.lo.y, piece.hi.y));
            most = std::max(most, length(exact - mean(mesh.positions)));
        }
    }
    return most;
}

TEST(PatchTessellation, APolygonWhoseHalvesCancelHasTheNormalOfItsPlane) {
    // Two squares of opposite orientation that meet in a vertex; a corner is off the plane.
    for (const double off : {0.0, 1e-12, 1e-7}) {
        Polygon squares;
        squares.vertices = {{0, 0, 0}, {1, 0, 0},  {1, 1, off}, {0, 1, 0},
                            {0, 0, 0}, {0, -1, 0}, {-1, -1, 0}, {-1, 0, 0}};
        squares.prepare();
        TriangleMesh mesh;
        ASSERT_EQ(append_triangles(AnyShape{squares}, 0.1, kLimit, mesh), "");
        for (const Vec3& n : mesh.normals) EXPECT_NEAR(std::abs(n.z), 1.0, 1e-6) << off;
    }
}

TEST(PatchTessellation, APolygonThatCrossesItselfIsFilledOddEven) {
    // Two triangles of unequal size: Newell's normal is that of the larger.
    Polygon bow;
    bow.vertices = {{-1, -1, 2}, {3, 3, 2}, {3, -3, 2}, {-1, 1, 2}};
    bow.prepare();
    TriangleMesh mesh;
    EXPECT_EQ(append_triangles(AnyShape{bow}, 0.1, kLimit, mesh), "");
    double area = 0.0;
    for (const auto& t : mesh.triangles) {
        const Vec3& a = mesh.positions[t[0]];
        const Vec3 twice = cross(mesh.positions[t[1]] - a, mesh.positions[t[2]] - a);
        EXPECT_GT(dot(twice, bow.normal), 0.0);
        area += 0.5 * length(twice);
    }
    EXPECT_NEAR(area, 10.0, 1e-5);
    for (const Vec3& n : mesh.normals) EXPECT_NEAR(dot(n, bow.normal), 1.0, 1e-12);
    // In its mean plane, if its corners are far off it.
    bow.vertices = {{-1, -1, 2.1}, {1, 1, 2.1}, {1, -1, 1.9}, {-1, 1, 1.9}};
    bow.prepare();
    TriangleMesh bent;
    EXPECT_EQ(append_triangles(AnyShape{bow}, 0.1, kLimit, bent), "");
    std::array<Vec3, 4> flat;
    for (std::size_t k = 0; k < 4; ++k) {
        const Vec3& p = bow.vertices[k];
        flat[k] = p - dot(p - bow.point, bow.normal) * bow.normal;
    }
    const auto [a, b, c, d] = flat;
    const double s = dot(cross(c - a, d - c), bow.normal) / dot(cross(b - a, d - c), bow.normal);
    const Vec3 crossing = a + s * (b - a);
    const double halves = 0.5 * (length(cross(b - crossing, c - crossing)) +
                                 length(cross(d - crossing, a - crossing)));
    EXPECT_NEAR(alhazen::area(bent), halves, 1e-6);
    for (const Vec3& p : bent.positions) EXPECT_NEAR(dot(p - bow.point, bow.normal), 0.0, 1e-9);
}

TEST(PatchTessellation, IsWithinTheTolerance) {
    Random random(1);
    std::size_t triangles = 0;
    for (int i = 0; i < 60; ++i) {
        const auto patch = RandomShape<BezierPatch>::make({random, i % 2 == 1});
        const BezierPiece piece{.net = patch.net()};
        const double size = max_component(control_box(piece.net).size());
        for (const double tolerance : {0.1 * size, 0.01 * size}) {
            TriangleMesh mesh;
            // Patches of large weights need very many.
            if (!append_triangles(piece, tolerance, 20'000, mesh)) continue;
            EXPECT_LE(largest_distance(piece, mesh, random), tolerance * (1 + 1e-9)) << i;
            triangles += mesh.triangles.size();
        }
    }
    EXPECT_GT(triangles, 10000u);
}

TEST(PatchTessellation, AlongTheLinesOfACylinderOneCellIsEnough) {
    // A quarter of a cylinder, rational along u and straight along v.
    BezierPatch patch{.degree_u = 2, .degree_v = 1};
    for (const auto& [x, y] : {std::pair{1.0, 0.0}, {1.0, 1.0}, {0.0, 1.0}}) {
        patch.points.push_back({x, y, 0});
        patch.points.push_back({x, y, 2});
        const double weight = x == y ? std::sqrt(0.5) : 1.0;
        patch.weights.insert(patch.weights.end(), 2, weight);
    }
    patch.prepare();
    const BezierPiece piece{.net = patch.net()};
    std::size_t before = 0;
    for (const double tolerance : {1e-3, 1e-5, 1e-7}) {
        TriangleMesh mesh;
        ASSERT_TRUE(append_triangles(piece, tolerance, kLimit, mesh));
        // The chords of a circle are as many as the root of 1 / tolerance.
        if (before > 0) {
            EXPECT_LT(mesh.triangles.size(), 20 * before);
        }
        before = mesh.triangles.size();
    }
}

TEST(PatchTessellation, APatchOfDegreeOneIsDividedLikeThatOfDegreeTwo) {
    const Vec3 corners[2][2] = {{{0, 0, 0}, {0, 2, 1}}, {{2, 0, 1}, {2, 2, 0}}};
    const double weights[2][2] = {{1, 2}, {5, 20}};
    BezierPatch one{.degree_u = 1, .degree_v = 1}, two{.degree_u = 2, .degree_v = 2};
    for (int i = 0; i <= 2; ++i) {
        for (int j = 0; j <= 2; ++j) {
            Vec3 point;
            double weight = 0;
            for (const auto& [a, b] : {std::pair{i / 2, j / 2},
                                       {(i + 1) / 2, j / 2},
                                       {i / 2, (j + 1) / 2},
                                       {(i + 1) / 2, (j + 1) / 2}}) {
                point += 0.25 * weights[a][b] * corners[a][b];
                weight += 0.25 * weights[a][b];
            }
            two.points.push_back(point / weight);
            two.weights.push_back(weight);
            if (i == 1 || j == 1) continue;
            one.points.push_back(two.points.back());
            one.weights.push_back(weight);
        }
    }
    std::vector<std::size_t> counts;
    Random random(4);
    for (BezierPatch patch : {one, two}) {
        patch.prepare();
        const BezierPiece piece{.net = patch.net()};
        TriangleMesh mesh;
        ASSERT_TRUE(append_triangles(piece, 0.01, kLimit, mesh));
        EXPECT_LE(largest_distance(piece, mesh, random), 0.01 * (1 + 1e-9));
        counts.push_back(mesh.triangles.size());
    }
    EXPECT_LT(counts[0], 2 * counts[1]);
}

template <class S>
TriangleMesh mesh_of(S shape, double tolerance) {
    shape.prepare();
    TriangleMesh mesh;
    EXPECT_EQ(append_triangles(AnyShape{shape}, tolerance, kLimit, mesh), "");
    EXPECT_EQ(mesh.normals.size(), mesh.positions.size());
    EXPECT_EQ(mesh.uvs.size(), mesh.positions.size());
    return mesh;
}

TEST(ShapeTessellation, ClosedShapesGiveClosedMeshesOfTheirVolume) {
    Sphere sphere{.center = {1, 2, 3}, .radius = 1.5};
    Torus torus;
    torus.prepare();
    const double tube = torus.minor_radius, ring = torus.major_radius;
    Cylinder cylinder{.base = {0, 0, 0}, .top = {1, 2, 2}, .radius = 0.75};
    BoxShape box{.lo = {-1, 0.1, 0.3}, .hi = {0.7, 2, 3.3}};
    for (const double tolerance : {1e-1, 1e-2, 1e-3}) {
        const auto check = [&](const TriangleMesh& mesh, double volume, double area_of_shape) {
            EXPECT_TRUE(mesh.closed());
            EXPECT_NEAR(signed_volume(mesh), volume, area_of_shape * tolerance + 1e-12);
        };
        check(mesh_of(sphere, tolerance), 4.0 / 3.0 * kPi * 3.375, 4 * kPi * 2.25);
        check(mesh_of(torus, tolerance), 2 * kPi * kPi * ring * tube * tube,
              4 * kPi * kPi * ring * tube);
        check(mesh_of(cylinder, tolerance), kPi * 0.5625 * 3, 2 * kPi * 0.75 * 3.75);
        check(mesh_of(box, tolerance), 1.7 * 1.9 * 3.0, 0.0);
    }
}

TEST(ShapeTessellation, NormalsAreThoseOfTheSurface) {
    const TriangleMesh mesh = mesh_of(Sphere{.center = {0, 0, 0}, .radius = 2}, 0.01);
    for (std::size_t k = 0; k < mesh.positions.size(); ++k) {
        // At the poles the limit is approached from within the patch.
        ASSERT_LT(length(mesh.normals[k] - 0.5 * mesh.positions[k]), 1e-8);
    }
}

TEST(ShapeTessellation, StraightCurvesOfUnevenSpeedDoNotGrow) {
    // Control points on a line, crowded at one end.
    BezierPatch patch{.degree_u = 3, .degree_v = 1};
    for (const double x : {0.0, 0.01, 0.02, 1.0}) {
        patch.points.push_back({x, 0, 0});
        patch.points.push_back({x, 1, 0.5 * x});
    }
    const TriangleMesh mesh = mesh_of(patch, 1e-3);
    EXPECT_LT(mesh.triangles.size(), 20000u);
}

TEST(ShapeTessellation, HeightFieldsAreTheirTriangles) {
    HeightField field{.columns = 3, .rows = 2, .base = -0.5};
    field.heights = std::make_shared<std::vector<float>>(std::vector<float>{0, 1, 0, 0.5, 0, 0.25});
    const TriangleMesh mesh = mesh_of(field, 1.0);
    EXPECT_EQ(mesh.triangles.size(), 4u * 2 + 4 * 3);
    EXPECT_TRUE(mesh.closed());
}

/// A flat sheet of 4 by 2 over the domain [2, 6] x [0, 1] with a round hole of radius 0.5.
NurbsSurface sheet_with_hole() {
    NurbsSurface sheet;
    sheet.degree_u = sheet.degree_v = 1;
    sheet.knots_u = {2, 2, 6, 6};
    sheet.knots_v = {0, 0, 1, 1};
    sheet.points = {{0, 0, 1}, {0, 2, 1}, {4, 0, 1}, {4, 2, 1}};
    const TrimCurve border{.points = {{2, 0}, {6, 0}, {6, 1}, {2, 1}, {2, 0}}};
    TrimCurve hole{.degree = 2, .knots = {0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4}};
    for (int k = 0; k < 9; ++k) {
        const double f = k % 2 == 0 ? 1.0 : std::sqrt(2.0);
        hole.points.push_back(
            {4 + 0.5 * f * std::cos(k * kPi / 4), 0.5 + 0.25 * f * std::sin(k * kPi / 4)});
        hole.weights.push_back(1.0 / f);
    }
    sheet.trims = {{border}, {hole}};
    return sheet;
}

TEST(ShapeTessellation, LoopsCutTheTrianglesOfANurbsSurface) {
    for (const double tolerance : {0.1, 0.01, 0.001}) {
        const TriangleMesh mesh = mesh_of(sheet_with_hole(), tolerance);
        double area = 0;
        for (const auto& t : mesh.triangles) {
            const Vec3 a = mesh.positions[t[0]];
            area += 0.5 * cross(mesh.positions[t[1]] - a, mesh.positions[t[2]] - a).z;
            const Vec3 middle = (a + mesh.positions[t[1]] + mesh.positions[t[2]]) / 3;
            EXPECT_GE(length(middle - Vec3{2, 1, 1}), 0.5 - tolerance);
        }
        EXPECT_NEAR(area, 8 - 0.25 * kPi, 0.5 * tolerance);
        for (std::size_t k = 0; k < mesh.positions.size(); ++k) {
            const Vec3 p = mesh.positions[k];
            ASSERT_NEAR(mesh.uvs[k].x, p.x / 4, 1e-12);
            ASSERT_NEAR(mesh.uvs[k].y, p.y / 2, 1e-12);
        }
    }
}

/// The surface of a prepared shape nearest to a point, along a normal.
template <class S>
ShapeSurface surface_near(const S& shape, const Vec3& point, const Vec3& normal) {
    const Ray ray{point, normal, -0.1, 0.1};
    ShapeHits hits;
    append_hits(shape, ray, hits);
    ShapeSurface nearest;
    double least = 1.0;
    for (const ShapeHit& hit : hits) {
        const ShapeSurface surface = shape.surface(ray, hit);
        if (std::abs(hit.t) > least || dot(surface.normal, normal) < 0.5) continue;
        least = std::abs(hit.t);
        nearest = surface;
    }
    EXPECT_LT(least, 1.0) << S::kName;
    return nearest;
}

/// Expects the interpolated texture coordinates in triangles to be those of the shape, up to whole
/// turns and to a distance on the surface. Returns the largest range of u in a triangle.
template <class S>
double check_uvs(S shape, double most_apart) {
    const TriangleMesh mesh = mesh_of(shape, 0.002);
    shape.prepare();
    double range = 0.0;
    for (const auto& t : mesh.triangles) {
        const Vec3 a = mesh.positions[t[0]], b = mesh.positions[t[1]], c = mesh.positions[t[2]];
        const Vec3 across = cross(b - a, c - a);
        if (!(length(across) > 1e-7)) continue;
        const ShapeSurface exact = surface_near(shape, (a + b + c) / 3, normalize(across));
        const Vec2 uv = (1.0 / 3.0) * (mesh.uvs[t[0]] + mesh.uvs[t[1]] + mesh.uvs[t[2]]);
        const auto off = [](double x, double y) { return x - y - std::round(x - y); };
        const Vec3 apart = off(uv.x, exact.uv.x) * exact.dpdu + off(uv.y, exact.uv.y) * exact.dpdv;
        EXPECT_LT(length(apart), most_apart) << S::kName << " at " << uv.x << ' ' << uv.y
                                             << ", not " << exact.uv.x << ' ' << exact.uv.y;
        for (std::size_t k = 0; k < 3; ++k) {
            range = std::max(range, std::abs(mesh.uvs[t[k]].x - mesh.uvs[t[(k + 1) % 3]].x));
        }
    }
    return range;
}

TEST(ShapeTessellation, TrianglesHaveTheTextureCoordinatesOfTheShape) {
    // Rings are divided into at least eight; no triangle spans a seam backwards.
    const auto check = [](auto shape) { EXPECT_LT(check_uvs(shape, 0.02), 0.3) << shape.kName; };
    check(Sphere{.center = {1, 2, 3}, .radius = 1.3});
    check(Ellipsoid{.axis_a = {1.5, 0, 0}, .axis_b = {0, 1, 0.3}, .axis_c = {0, 0, 0.7}});
    check(Ellipsoid{.axis_a = {1.5, 0, 0}, .axis_b = {0, -1, 0.3}, .axis_c = {0, 0, 0.7}});
    check(Torus{.center = {0, 1, 0}, .axis = {1, 2, 3}, .major_radius = 1.2, .minor_radius = 0.4});
    check(Disc{.center = {0, 0, 1}, .radius = 1.5, .inner_radius = 0.5});
    check(Disc{.radius = 1.5});
    check(Cylinder{.base = {0, -1, 0}, .top = {0, 1, 0.3}});
    check(Cone{.base = {0, -1, 0}, .top = {0, 1, 0.3}});
    check(Cone{.base = {0, -1, 0}, .top = {0, 1, 0.3}, .base_radius = 1.2, .top_radius = 0.4});
    check(EllipticCylinder{.axis_a = {1.5, 0, 0}, .axis_b = {0, 1, 0.3}});
    check(EllipticCone{.axis_a = {1.5, 0, 0}, .axis_b = {0, 1, 0.3}});
    check(Tgc{.axis_a = {1.5, 0, 0},
              .axis_b = {0, 1, 0.3},
              .axis_c = {0.5, 0, 0},
              .axis_d = {0, 0.7, 0.21}});
    check(Paraboloid{});
    check(Hyperboloid{});
    check(TwoSheetHyperboloid{});
}

TEST(ShapeTessellation, TrianglesOfASteinerPatchHaveItsParameters) {
    SteinerPatch patch{
        .points = {{-1, -1, 0}, {0, -1, 0.5}, {0, 0, 0}, {0, -0.5, 0.2}, {0.5, 0.5, 0}, {0, 1, 0}}};
    const TriangleMesh mesh = mesh_of(patch, 0.002);
    patch.prepare();
    for (std::size_t k = 0; k < mesh.positions.size(); ++k) {
        ShapeHit hit;
        hit.u = mesh.uvs[k].x;
        hit.v = mesh.uvs[k].y;
        EXPECT_LT(length(patch.surface(Ray{}, hit).point - mesh.positions[k]), 1e-9);
    }
}

TEST(ShapeTessellation, FacesHaveTheTextureCoordinatesOfTheShape) {
    const auto check = [](auto shape) { check_uvs(shape, 1e-9); };
    check(BoxShape{.lo = {-1, 0.1, 0.3}, .hi = {0.7, 2, 3.3}});
    check(Rectangle{.corner = {-1, -1, 0}, .edge_u = {2, 0, 0}, .edge_v = {0.5, 2, 0}});
    check(Polygon{.vertices = {{-1, -1, 2}, {3, -1, 2}, {3, 4, 2}}});
    check(hexahedron({{{-1, -1, -1},
                       {1, -1, -1},
                       {1, 1, -1},
                       {-1, 1, -1},
                       {-1, -1, 1},
                       {1, -1, 1},
                       {1, 1, 1},
                       {-1, 1, 1}}}));
    HeightField field{.columns = 3, .rows = 2, .base = -0.5};
    field.heights = std::make_shared<std::vector<float>>(std::vector<float>{0, 1, 0, 0.5, 0, 0.25});
    check(field);
}

TEST(ShapeTessellation, TrianglesOfAPolygonThatMeetsItselfCoverItOnce) {
    const auto area_of = [](const std::vector<Vec3>& loop) {
        const TriangleMesh mesh = mesh_of(Polygon{.vertices = loop}, 0.01);
        double sum = 0.0;
        for (const auto& [a, b, c] : mesh.triangles) {
            const Vec3 normal =
                cross(mesh.positions[b] - mesh.positions[a], mesh.positions[c] - mesh.positions[a]);
            // On the side of the normals of its corners.
            EXPECT_GE(dot(normal, mesh.normals[a]), -1e-12);
            sum += 0.5 * length(normal);
        }
        return sum;
    };
    for (const testing::LoopOfArea& c : testing::touching_loops()) {
        EXPECT_NEAR(area_of(c.loop), c.area, 1e-6);
    }
    Random random(21);
    for (int round = 0; round < 2000; ++round) {
        const std::vector<Vec3> loop = testing::random_loop(random);
        const double area = testing::odd_even_area(loop);
        if (!(area > 0.0)) continue;
        EXPECT_NEAR(area_of(loop), area, 1e-5) << round;
    }
}

TEST(ShapeTessellation, FacesOfAPolyhedronInEitherOrderTurnOutward) {
    Polyhedron solid;
    solid.vertices = {{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {0, 0, 2}};
    // The first and the third are clockwise from outside.
    solid.corners = {0, 1, 2, 0, 1, 3, 0, 2, 3, 1, 2, 3};
    solid.face_ends = {3, 6, 9, 12};
    const TriangleMesh mesh = mesh_of(solid, 0.1);
    EXPECT_NEAR(signed_volume(mesh), 8.0 / 6, 1e-12);
    check_uvs(solid, 1e-9);
}

TEST(ShapeTessellation, APolyhedronOfPlanesIsItsFaces) {
    // The tolerance is as large as the solid. Four planes meet in the apex, a plane occurs twice,
    // one cuts nothing off.
    Polyhedron pyramid;
    for (int k = 0; k < 5; ++k) {
        const double a = kPi / 2 * (k % 4);
        pyramid.planes.push_back({{std::cos(a), std::sin(a), 0}, {std::cos(a), std::sin(a), 0.1}});
    }
    pyramid.planes.push_back({{0, 0, 0}, {0, 0, -1}});
    pyramid.planes.push_back({{0, 0, 11}, {0, 0, 1}});
    const TriangleMesh mesh = mesh_of(pyramid, 20);
    EXPECT_EQ(mesh.triangles.size(), 6u);
    EXPECT_NEAR(signed_volume(mesh), 4.0 * 10 / 3, 1e-9);
    EXPECT_TRUE(mesh.closed());
    EXPECT_EQ(mesh_edges(mesh).crowded, 0u);
    check_uvs(pyramid, 1e-9);

    // Random planes that touch a sphere: no more than 3 f - 6 edges, each of two triangles.
    Random random(11);
    for (int round = 0; round < 20; ++round) {
        Polyhedron solid;
        for (int k = 0; k < 24; ++k) {
            const Vec3 n = random.unit_vector();
            solid.planes.push_back({n, n});
        }
        solid.prepare();
        if (!solid.bounds.bounded() || max_component(solid.bounds.size()) > 50) continue;
        const TriangleMesh faces = mesh_of(solid, 0.001);
        EXPECT_LE(faces.triangles.size(), 2u * 44 - 4);
        EXPECT_TRUE(faces.closed());
        EXPECT_EQ(mesh_edges(faces).crowded, 0u);
        for (const Vec3& p : faces.positions) {
            for (const OrientedPlane& f : solid.faces) {
                EXPECT_LE(dot(p - f.point, f.normal), 1e-9 * 50);
            }
        }
    }
}

TEST(ShapeTessellation, AConeThatEndsInAnEdgeHasNoCapThere) {
    for (const Vec3& d : {Vec3{0, 0, 0}, Vec3{0.3, 0, 0}}) {
        Tgc cone;
        cone.axis_d = d;
        cone.prepare();
        std::vector<BezierPiece> pieces;
        append_pieces(cone, pieces);
        std::set<std::uint32_t> parts;
        for (const BezierPiece& piece : pieces) parts.insert(piece.part);
        EXPECT_EQ(parts, (std::set<std::uint32_t>{0, 5}));
    }
    // The edge is then one of the mesh: of two triangles, not of four.
    Tgc wedge;
    wedge.axis_d = {0, 0, 0};
    const TriangleMesh mesh = mesh_of(wedge, 0.01);
    EXPECT_TRUE(mesh.closed());
    EXPECT_EQ(mesh_edges(mesh).crowded, 0u);
}

TEST(ShapeTessellation, ALatheHasTheOutsideAndTheTextureCoordinatesOfItsProfile) {
    // Both directions of the profile.
    for (const bool down : {false, true}) {
        Lathe lathe;
        const Vec2 a{0, -1}, b{1, -1}, c{1, 0}, d{0.5, 1}, e{0.3, 1}, f{0, 1};
        lathe.profile.curves = {line_curve(a, b), cubic_curve(b, c, d, e), line_curve(e, f)};
        if (down) {
            lathe.profile.curves = {line_curve(f, e), cubic_curve(e, d, c, b), line_curve(b, a)};
        }
        lathe.profile.loop_ends = {3};
        EXPECT_GT(signed_volume(mesh_of(lathe, 0.01)), 4.0);
        EXPECT_LT(check_uvs(lathe, 0.02), 0.3);
    }
}

TEST(ShapeTessellation, NamesWhatItCannot) {
    const auto refusal = [](AnyShape shape) {
        std::visit([](auto& s) { s.prepare(); }, shape);
        TriangleMesh mesh;
        const std::string text = append_triangles(shape, 0.1, kLimit, mesh);
        EXPECT_TRUE(mesh.positions.empty() && mesh.triangles.empty());
        return text;
    };
    EXPECT_EQ(refusal(Plane{}), "is endless");
    EXPECT_EQ(refusal(Superellipsoid{}), kNeedsLines);
    Sphere sphere;
    sphere.prepare();
    TriangleMesh mesh;
    EXPECT_EQ(append_triangles(AnyShape{sphere}, 1e-9, 1000, mesh), kTooManyTriangles);
    EXPECT_TRUE(mesh.positions.empty());
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
