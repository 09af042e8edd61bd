// Triangles of solids by lines: closed, within the tolerance in both directions, with their
// materials.

#include "alhazen/solids/triangles/solid_triangles.h"

#include <gtest/gtest.h>

#include <set>

#include "alhazen/geometry/polygon/merged_positions.h"
#include "alhazen/math/constants.h"
#include "alhazen/math/unit_vector.h"
#include "alhazen/parallel/parallel.h"
#include "alhazen/shapes/meshes/mesh_edges.h"
#include "mesh_distance.h"
#include "support/random.h"
#include "support/random_profiles.h"
#include "support/scene_maker.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::Random;
using testing::SceneMaker;

/// The mesh of the only solid of a scene.
TriangleMesh mesh_of(SceneMaker& maker, double tolerance) {
    const SolidList solids(maker.compile().aggregate);
    EXPECT_EQ(solids.count(), 1u);
    const IsolatedSolid solid(solids, SolidId{0});
    TriangleMesh mesh;
    EXPECT_TRUE(make_solid_triangles(solid, tolerance, 2'000'000, mesh));
    EXPECT_TRUE(mesh.closed());
    EXPECT_FALSE(mesh.triangles.empty());
    return mesh;
}

/// Largest distance of random points of the mesh to the solid, along the best of many lines.
double largest_distance(const IsolatedSolid& solid, const TriangleMesh& mesh, double limit) {
    Random random(7);
    double most = 0;
    const int count = static_cast<int>(mesh.triangles.size());
    for (int i = 0; i < 2000; ++i) {
        const auto& t = mesh.triangles[static_cast<std::size_t>(random.below(count))];
        double a = random.uniform(), b = random.uniform();
        if (a + b > 1) a = 1 - a, b = 1 - b;
        const Vec3 p = a * mesh.positions[t[0]] + b * mesh.positions[t[1]] +
                       (1 - a - b) * mesh.positions[t[2]];
        double nearest = 100 * limit;
        for (int k = 0; k < 60 && nearest > limit; ++k) {
            std::vector<IsolatedSolid::SurfacePoint> found;
            solid.crossings({p, random.unit_vector(), -100 * limit, 100 * limit}, found);
            for (const auto& point : found) nearest = std::min(nearest, length(point.point - p));
        }
        most = std::max(most, nearest);
    }
    return most;
}

/// A random rotation, and a random way of at most `far`.
Affine placed(Random& random, double far) {
    return Affine::translate(random.uniform(0, far) * random.unit_vector()) *
           Affine::rotate(random.unit_vector(), random.uniform(0, 3));
}

double volume_of(const TriangleMesh& mesh) {
    double six = 0;
    for (const auto& t : mesh.triangles) {
        six += dot(mesh.positions[t[0]], cross(mesh.positions[t[1]], mesh.positions[t[2]]));
    }
    return six / 6;
}

TEST(SolidTriangles, OfSmoothSolidsAreFewAndNear) {
    SceneMaker maker;
    maker.add(Superellipsoid{});
    const SolidList solids(maker.compile().aggregate);
    const IsolatedSolid solid(solids, SolidId{0});
    for (const double tolerance : {0.1, 0.01}) {
        const TriangleMesh mesh = mesh_of(maker, tolerance);
        EXPECT_LE(largest_distance(solid, mesh, tolerance), tolerance);
        EXPECT_LT(mesh.triangles.size(), 400'000u);
        EXPECT_TRUE(mesh.vertex_materials.empty() || mesh.vertex_materials[0] == 0);
    }
}

/// A box with a bore, of two materials.
void add_bored_box(SceneMaker& maker) {
    const MaterialId steel = maker.material({}), brass = maker.material({});
    const ObjectIndex cut = maker.object("bored");
    maker.description().objects.back().combine = Combine::Difference;
    maker.add(BoxShape{.lo = {-1, -1, -0.5}, .hi = {1, 1, 0.5}}, steel, {}, cut);
    maker.add(Cylinder{.base = {0, 0, -1}, .top = {0, 0, 1}, .radius = 0.5}, brass, {}, cut);
    maker.add(cut);
}

TEST(SolidTriangles, OfASolidWithEdgesHaveItsVolumeAndMaterials) {
    SceneMaker maker;
    add_bored_box(maker);
    const SolidList solids(maker.compile().aggregate);
    const IsolatedSolid solid(solids, SolidId{0});
    const double tolerance = 0.05;
    const TriangleMesh mesh = mesh_of(maker, tolerance);
    EXPECT_LE(largest_distance(solid, mesh, tolerance), tolerance);
    EXPECT_NEAR(volume_of(mesh), 4 - 0.25 * kPi, 0.5 * tolerance);
    ASSERT_EQ(mesh.vertex_materials.size(), mesh.positions.size());
    std::set<std::uint32_t> used;
    for (const auto& t : mesh.triangles) {
        const std::uint32_t material = mesh.vertex_materials[t[0]];
        used.insert(material);
        EXPECT_EQ(material, mesh.vertex_materials[t[1]]);
        EXPECT_EQ(material, mesh.vertex_materials[t[2]]);
        const Vec3 middle =
            (mesh.positions[t[0]] + mesh.positions[t[1]] + mesh.positions[t[2]]) / 3;
        const double radius = std::hypot(middle.x, middle.y);
        if (std::abs(radius - 0.5) > tolerance) {
            EXPECT_EQ(material, 0u) << radius;
        }
    }
    EXPECT_EQ(used.size(), 2u);
}

TEST(SolidTriangles, HaveTheTextureCoordinatesOfTheOperandsIfWanted) {
    SceneMaker maker;
    add_bored_box(maker);
    const SolidList solids(maker.compile().aggregate);
    const IsolatedSolid solid(solids, SolidId{0});
    TriangleMesh plain, mesh;
    ASSERT_TRUE(make_solid_triangles(solid, 0.05, 2'000'000, plain));
    ASSERT_TRUE(make_solid_triangles(solid, 0.05, 2'000'000, mesh, true));
    for (const Vec2& uv : plain.uvs) EXPECT_EQ(uv, (Vec2{0, 0}));
    ASSERT_EQ(mesh.uvs.size(), mesh.positions.size());
    int tops = 0, bores = 0;
    for (const auto& t : mesh.triangles) {
        Vec3 normal;
        Vec2 lo{9, 9}, hi{-9, -9};
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec2 uv = mesh.uvs[t[k]];
            lo = {std::min(lo.x, uv.x), std::min(lo.y, uv.y)};
            hi = {std::max(hi.x, uv.x), std::max(hi.y, uv.y)};
            normal = normal + mesh.normals[t[k]];
        }
        const bool is_top = normal.z > 2.9, is_bore = mesh.vertex_materials[t[0]] == 1;
        for (const std::uint32_t corner : t) {
            const Vec3 p = mesh.positions[corner];
            const Vec2 uv = mesh.uvs[corner];
            if (is_top) {
                EXPECT_NEAR(uv.x, 0.5 * (p.x + 1), 1e-9);
                EXPECT_NEAR(uv.y, 0.5 * (p.y + 1), 1e-9);
                ++tops;
            } else if (is_bore) {
                EXPECT_NEAR(uv.y, 0.5 * (p.z + 1), 1e-3);
                const Vec3 around = perpendicular(Vec3{0, 0, 1});
                const Vec3 across = cross(Vec3{0, 0, 1}, around);
                const double turns = std::atan2(dot(across, p), dot(around, p)) / (2 * kPi);
                EXPECT_NEAR(uv.x, turns + std::round(uv.x - turns), 1e-9);
                ++bores;
            }
        }
        // Triangles across the seam go on.
        if (is_bore) {
            EXPECT_LT(hi.x - lo.x, 0.2);
        }
    }
    EXPECT_GT(tops, 30);
    EXPECT_GT(bores, 60);
}

TEST(SolidTriangles, ThinPartsAreFoundWhateverTheirDirection) {
    for (int axis = 0; axis < 3; ++axis) {
        SceneMaker maker;
        Vec3 lo{-1, -1, -1}, hi{1, 1, 1};
        lo[axis] = 0.11;
        hi[axis] = 0.14;
        const ObjectIndex both = maker.object("plate and ball");
        maker.description().objects.back().combine = Combine::Union;
        maker.add(BoxShape{.lo = lo, .hi = hi}, MaterialId{0}, {}, both);
        maker.add(Sphere{.center = {0, 0, 0}, .radius = 0.4}, MaterialId{0}, {}, both);
        (void)maker.material({});
        maker.add(both);
        const TriangleMesh mesh = mesh_of(maker, 0.02);
        Box3 box;
        for (const Vec3& p : mesh.positions) box.include(p);
        for (int k = 0; k < 3; ++k) {
            EXPECT_NEAR(box.hi[k], k == axis ? 0.4 : 1.0, 0.02) << axis;
        }
    }
}

/// A box without another one, turned by `turn`.
ObjectIndex add_cut_box(SceneMaker& maker, const Affine& turn) {
    const ObjectIndex cut = maker.object("cut");
    maker.description().objects.back().combine = Combine::Difference;
    maker.add(BoxShape{.lo = {-1, -1, -1}, .hi = {1, 1, 1}}, MaterialId{0}, {}, cut);
    maker.add(BoxShape{.lo = {0, 0, 0}, .hi = {2, 2, 2}}, MaterialId{0}, turn, cut);
    (void)maker.material({});
    maker.add(cut);
    return cut;
}

TEST(SolidTriangles, OfFlatFacesAreFew) {
    for (const double tolerance : {0.1, 0.01, 0.002}) {
        SceneMaker maker;
        add_cut_box(maker, {});
        const TriangleMesh mesh = mesh_of(maker, tolerance);
        // Three faces of six corners, six squares.
        EXPECT_EQ(mesh.triangles.size(), 24u);
        EXPECT_NEAR(volume_of(mesh), 7, 24 * 0.1 * tolerance);
    }
    SceneMaker maker;
    add_cut_box(maker, Affine::rotate({1, 2, 3}, 0.7));
    const SolidList solids(maker.compile().aggregate);
    const IsolatedSolid solid(solids, SolidId{0});
    const TriangleMesh mesh = mesh_of(maker, 0.01);
    EXPECT_LT(mesh.triangles.size(), 300u);
    EXPECT_LE(largest_distance(solid, mesh, 0.01), 0.01);
}

TEST(SolidTriangles, OfFlatFacesAreFewBeforeTheyAreMerged) {
    SceneMaker maker;
    const ObjectIndex box = maker.object("turned box");
    maker.description().objects.back().combine = Combine::Union;
    const Affine turn = Affine::rotate({1, 2, 3}, 0.7);
    maker.add(BoxShape{.lo = {-1, -1, -1}, .hi = {1, 1, 1}}, MaterialId{0}, turn, box);
    (void)maker.material({});
    maker.add(box);
    const SolidList solids(maker.compile().aggregate);
    const IsolatedSolid solid(solids, SolidId{0});
    // The limit counts the triangles of the cells: on a lattice of one cell size, more than 10^6 at
    // each of these tolerances.
    for (const double tolerance : {1e-2, 1e-3, 1e-4}) {
        TriangleMesh mesh;
        ASSERT_TRUE(make_solid_triangles(solid, tolerance, 100'000, mesh)) << tolerance;
        EXPECT_TRUE(mesh_edges(mesh).oriented());
        EXPECT_LE(largest_distance(solid, mesh, tolerance), tolerance);
        EXPECT_NEAR(volume_of(mesh), 8, 24 * tolerance);
    }
}

/// Least distance of a vertex from a point.
double nearest_vertex(const TriangleMesh& mesh, const Vec3& point) {
    double least = kInfinity;
    for (const Vec3& p : mesh.positions) least = std::min(least, length(p - point));
    return least;
}

TEST(SolidTriangles, SmallPartsAreFoundBesideLargeOnes) {
    Random random(5);
    for (int round = 0; round < 12; ++round) {
        SceneMaker maker;
        const ObjectIndex both = maker.object("plate and ball");
        maker.description().objects.back().combine = Combine::Union;
        maker.add(BoxShape{.lo = {-1, -1, -1}, .hi = {1, 1, 0}}, MaterialId{0}, {}, both);
        const Vec3 at{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(0.1, 0.9)};
        maker.add(Sphere{.center = at, .radius = 0.01}, MaterialId{0}, {}, both);
        (void)maker.material({});
        maker.add(both);
        EXPECT_LT(nearest_vertex(mesh_of(maker, 0.005), at), 0.02) << round;
    }
}

TEST(SolidTriangles, SmallPartsWithoutAPrimitiveOfTheirSizeAreFound) {
    Random random(6);
    const double c = std::sqrt(1.0 / 3);
    for (int round = 0; round < 6; ++round) {
        SceneMaker maker;
        const ObjectIndex both = maker.object("ball and lens");
        const ObjectIndex lens = maker.object("lens");
        maker.description().objects[1].combine = Combine::Union;
        maker.description().objects[2].combine = Combine::Intersection;
        maker.add(Sphere{}, MaterialId{0}, {}, both);
        const Vec3 at{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(2, 2.5)};
        for (const double side : {-0.998, 0.998}) {
            maker.add(Sphere{.center = at + side * Vec3{c, c, c}}, MaterialId{0}, {}, lens);
        }
        maker.add(lens, MaterialId{0}, {}, both);
        (void)maker.material({});
        maker.add(both);
        EXPECT_LT(nearest_vertex(mesh_of(maker, 0.003), at), 0.064) << round;
    }
}

/// Largest distance of points of the axis of a bar from the nearest vertex.
double largest_gap(const TriangleMesh& mesh, const Vec3& from, const Vec3& to) {
    double most = 0;
    for (int k = 0; k <= 100; ++k) {
        most = std::max(most, nearest_vertex(mesh, from + 0.01 * k * (to - from)));
    }
    return most;
}

TEST(SolidTriangles, ThinPartsObliqueToTheAxesAreFound) {
    Random random(8);
    for (int round = 0; round < 6; ++round) {
        SceneMaker maker;
        const ObjectIndex both = maker.object("plate and bars");
        maker.description().objects.back().combine = Combine::Union;
        maker.add(BoxShape{.lo = {-1, -1, -1}, .hi = {1, 1, -0.9}}, MaterialId{0}, {}, both);
        const Vec3 half = 0.4 * random.unit_vector(), aside{2, 0, 0};
        maker.add(Cylinder{.base = -half, .top = half, .radius = 0.0015}, MaterialId{0}, {}, both);
        const Affine turn =
            Affine::translate(aside) * Affine::rotate(random.unit_vector(), random.uniform(0, 3));
        maker.add(BoxShape{.lo = {-0.4, -0.001, -0.001}, .hi = {0.4, 0.001, 0.001}}, MaterialId{0},
                  turn, both);
        (void)maker.material({});
        maker.add(both);
        const TriangleMesh mesh = mesh_of(maker, 0.0016);
        EXPECT_LT(largest_gap(mesh, -half, half), 0.1) << round;
        const Vec3 end = turn.vector({0.4, 0, 0});
        EXPECT_LT(nearest_vertex(mesh, aside - end), 0.005) << round;
        EXPECT_LT(nearest_vertex(mesh, aside + end), 0.005) << round;
    }
}

TEST(SolidTriangles, PartsOfInstancedSolidsAreFound) {
    SceneMaker maker;
    const ObjectIndex all = maker.object("plate and pairs");
    const ObjectIndex pair = maker.object("pair");
    maker.description().objects[1].combine = Combine::Union;
    maker.description().objects[2].combine = Combine::Union;
    maker.add(BoxShape{.lo = {-1, -1, -1}, .hi = {1, 1, -0.9}}, MaterialId{0}, {}, all);
    const Vec3 ends[2] = {{-0.6, 0.1, 0.3}, {0.7, 0.2, -0.3}};
    for (const Vec3& end : ends) {
        maker.add(Sphere{.center = end, .radius = 0.002}, MaterialId{0}, {}, pair);
    }
    std::vector<Affine> places;
    for (int k = 0; k < 3; ++k) {
        places.push_back(Affine::translate({0, 0, 0.7 * k}) * Affine::rotate({1, 2, 3}, 0.5 * k));
        maker.add(pair, MaterialId{0}, places.back(), all);
    }
    (void)maker.material({});
    maker.add(all);
    const TriangleMesh mesh = mesh_of(maker, 0.001);
    for (const Affine& place : places) {
        for (const Vec3& end : ends) EXPECT_LT(nearest_vertex(mesh, place.point(end)), 0.003);
    }
}

TEST(SolidTriangles, SmallPartsAreFoundHoweverMany) {
    constexpr int kSide = 17;
    SceneMaker maker;
    const ObjectIndex all = maker.object("grid");
    maker.description().objects.back().combine = Combine::Union;
    for (int k = 0; k < kSide * kSide * kSide; ++k) {
        const Vec3 at{double(k % kSide), double(k / kSide % kSide), double(k / kSide / kSide)};
        maker.add(BoxShape{.lo = at, .hi = at + Vec3{0.02, 0.02, 0.02}}, MaterialId{0}, {}, all);
    }
    (void)maker.material({});
    maker.add(all);
    const TriangleMesh mesh = mesh_of(maker, 0.008);
    EXPECT_EQ(mesh.triangles.size(), 12u * kSide * kSide * kSide);
}

TEST(SolidTriangles, OfRandomSolidsAreClosedAndNear) {
    Random random(12);
    for (int round = 0; round < 4; ++round) {
        SceneMaker maker;
        const ObjectIndex cut = maker.object("random");
        maker.description().objects.back().combine =
            round % 3 == 0 ? Combine::Union : Combine::Difference;
        maker.add(BoxShape{.lo = {-1, -1, -1}, .hi = {1, 1, 1}}, MaterialId{0}, placed(random, 0.1),
                  cut);
        maker.add(Cylinder{.base = {0, 0, -2}, .top = {0, 0, 2}, .radius = 0.4}, MaterialId{0},
                  placed(random, 0.3), cut);
        maker.add(BoxShape{.lo = {0, 0, 0}, .hi = {1, 2, 3}}, MaterialId{0}, placed(random, 0.5),
                  cut);
        maker.add(Sphere{.radius = 0.6}, MaterialId{0}, placed(random, 1), cut);
        (void)maker.material({});
        maker.add(cut);
        const SolidList solids(maker.compile().aggregate);
        const IsolatedSolid solid(solids, SolidId{0});
        const double tolerance = 0.06;
        TriangleMesh mesh;
        ASSERT_TRUE(make_solid_triangles(solid, tolerance, 2'000'000, mesh));
        EXPECT_TRUE(mesh_edges(mesh).oriented()) << round;
        EXPECT_LE(largest_distance(solid, mesh, tolerance), tolerance) << round;
        // Points of the surface; parts thinner than the tolerance may be missing.
        double most = 0;
        for (int i = 0; i < 200; ++i) {
            std::vector<IsolatedSolid::SurfacePoint> found;
            solid.crossings({2 * random.unit_vector(), random.unit_vector(), -10, 10}, found);
            for (const auto& p : found) {
                most = std::max(most, testing::distance(p.point, mesh));
            }
        }
        EXPECT_LE(most, tolerance) << round << " " << mesh.triangles.size();
    }
}

/// The area of the triangles that face away from all of the surface within `limit` of their
/// middles.
double area_turned_over(const IsolatedSolid& solid, const TriangleMesh& mesh, double limit) {
    Random random(9);
    double sum = 0;
    for (const auto& t : mesh.triangles) {
        const Vec3 a = mesh.positions[t[0]], b = mesh.positions[t[1]], c = mesh.positions[t[2]];
        const Vec3 normal = cross(b - a, c - a), p = (a + b + c) / 3;
        bool any = false, faces = false;
        for (int k = 0; k < 200 && !faces; ++k) {
            std::vector<IsolatedSolid::SurfacePoint> found;
            solid.crossings({p, random.unit_vector(), -limit, limit}, found);
            any = any || !found.empty();
            for (const auto& point : found) faces = faces || dot(point.normal, normal) > 0;
        }
        if (any && !faces) sum += 0.5 * length(normal);
    }
    return sum;
}

TEST(SolidTriangles, AreNotTurnedOverBesideSharpEdges) {
    Random random(21);
    for (int round = 0; round < 24; ++round) {
        SceneMaker maker;
        const ObjectIndex cut = maker.object("random");
        maker.description().objects.back().combine =
            round % 2 == 0 ? Combine::Intersection : Combine::Difference;
        maker.add(BoxShape{.lo = {-1, -1, -1}, .hi = {1, 1, 1}}, MaterialId{0}, placed(random, 0.1),
                  cut);
        maker.add(BoxShape{.lo = {-1, -1, -1}, .hi = {1, 1, 1}}, MaterialId{0}, placed(random, 0.9),
                  cut);
        maker.add(Cylinder{.base = {0, 0, -2}, .top = {0, 0, 2}, .radius = 0.8}, MaterialId{0},
                  placed(random, 0.9), cut);
        (void)maker.material({});
        maker.add(cut);
        const SolidList solids(maker.compile().aggregate);
        if (solids.count() != 1) continue;
        const IsolatedSolid solid(solids, SolidId{0});
        const double tolerance = round % 3 == 0 ? 0.04 : 0.015;
        TriangleMesh mesh;
        ASSERT_TRUE(make_solid_triangles(solid, tolerance, 2'000'000, mesh));
        EXPECT_TRUE(mesh_edges(mesh).oriented()) << round;
        // Less than a side of one of the smallest cells, which are not tested.
        EXPECT_LE(area_turned_over(solid, mesh, tolerance), tolerance * tolerance / 12) << round;
    }
}

/// The number of triangles on the same three positions as one before them.
std::size_t doubled(const TriangleMesh& mesh) {
    const std::vector<std::uint32_t> first = merged_positions(mesh.positions);
    std::set<std::set<std::uint32_t>> seen;
    for (const auto& t : mesh.triangles) seen.insert({first[t[0]], first[t[1]], first[t[2]]});
    return mesh.triangles.size() - seen.size();
}

TEST(SolidTriangles, OfKnifeEdgesAreNoDoubledSheets) {
    for (const double tolerance : {0.03, 0.01}) {
        SceneMaker maker;
        Prism prism;
        testing::add_polygon(prism.profile, {{1, 0.2}, {-0.5, 0.8}, {-0.7, -0.8}});
        prism.h1 = 0.2;
        prism.top_scale = 0;
        maker.add(prism);
        const TriangleMesh pyramid = mesh_of(maker, tolerance);
        EXPECT_EQ(doubled(pyramid), 0u);
        EXPECT_EQ(mesh_edges(pyramid).crowded, 0u);
        // Along its rim the part that is thinner than the tolerance may be missing.
        EXPECT_NEAR(volume_of(pyramid), 1.26 * 0.2 / 3, 6.3 * tolerance * tolerance);

        SceneMaker lens_maker;
        const ObjectIndex lens = lens_maker.object("lens");
        lens_maker.description().objects.back().combine = Combine::Intersection;
        lens_maker.add(Sphere{.center = {0, 0, -1.7}, .radius = 2}, {}, {}, lens);
        lens_maker.add(Sphere{.center = {0, 0, 1.7}, .radius = 2}, {}, {}, lens);
        lens_maker.add(lens);
        const TriangleMesh made = mesh_of(lens_maker, tolerance);
        EXPECT_EQ(doubled(made), 0u);
        EXPECT_EQ(mesh_edges(made).crowded, 0u);
    }
}

TEST(SolidTriangles, AreTheSameForAnyNumberOfThreads) {
    SceneMaker maker;
    add_bored_box(maker);
    TriangleMesh one, several;
    ThreadLimit(1).run([&] { one = mesh_of(maker, 0.003); });
    ThreadLimit(4).run([&] { several = mesh_of(maker, 0.003); });
    EXPECT_EQ(one.triangles, several.triangles);
    EXPECT_EQ(one.positions, several.positions);
    EXPECT_EQ(one.normals, several.normals);
}

TEST(SolidTriangles, HaveALimitThatNamesALargerTolerance) {
    SceneMaker maker;
    maker.add(Superellipsoid{});
    const SolidList solids(maker.compile().aggregate);
    const IsolatedSolid solid(solids, SolidId{0});
    for (const std::uint64_t most : {20'000u, 100'000u}) {
        TriangleMesh mesh;
        SolidTrianglesReport report{.larger_tolerance = 1e-6};
        int tries = 0;
        for (bool made = false; !made && tries < 9; ++tries) {
            const double tolerance = report.larger_tolerance;
            made = make_solid_triangles(solid, tolerance, most, mesh, false, &report);
            if (!made) {
                EXPECT_GT(report.larger_tolerance, tolerance);
            }
        }
        EXPECT_LE(tries, 4) << report.larger_tolerance;
        EXPECT_LT(report.larger_tolerance, 0.05);
    }
}

TEST(SolidTriangles, TellOfPartsAndGapsThatAreTooThin) {
    // A ball with a bar through it, a box, and bars and bores beside them.
    struct Case {
        int count;
        double radius;
        int lost;
    };
    for (const Case& own : {Case{0, 0.1, 0}, {1, 2e-4, 2}, {3, 2e-4, 6}, {3, 0.02, 0}}) {
        SceneMaker maker;
        const ObjectIndex all = maker.object("bars");
        const ObjectIndex cut = maker.object("cut");
        maker.description().objects[1].combine = Combine::Union;
        maker.description().objects[2].combine = Combine::Difference;
        maker.add(Sphere{}, MaterialId{0}, {}, all);
        maker.add(Cylinder{.base = {0, 0, -2}, .top = {0, 0, 2}, .radius = 0.1}, MaterialId{0}, {},
                  all);
        maker.add(BoxShape{.lo = {3, -2, -2}, .hi = {5, 2, 2}}, MaterialId{0}, {}, cut);
        for (int k = 0; k < own.count; ++k) {
            const double x = 1.5 + 0.2 * k;
            maker.add(Cylinder{.base = {x, 0.3, -2}, .top = {x, 0.5, 2}, .radius = own.radius},
                      MaterialId{0}, {}, all);
            maker.add(
                Cylinder{
                    .base = {x + 2, 0.3, -2.5}, .top = {x + 2, 0.5, 2.5}, .radius = own.radius},
                MaterialId{0}, {}, cut);
        }
        maker.add(cut, MaterialId{0}, {}, all);
        (void)maker.material({});
        maker.add(all);
        const SolidList solids(maker.compile().aggregate);
        const IsolatedSolid solid(solids, SolidId{0});
        TriangleMesh mesh;
        SolidTrianglesReport report;
        ASSERT_TRUE(make_solid_triangles(solid, 0.02, 2'000'000, mesh, false, &report));
        EXPECT_EQ(report.lost_parts, std::uint64_t(own.lost));
    }
}

TEST(SolidTriangles, HaveALimit) {
    SceneMaker maker;
    maker.add(Superellipsoid{});
    const SolidList solids(maker.compile().aggregate);
    const IsolatedSolid solid(solids, SolidId{0});
    TriangleMesh mesh;
    EXPECT_FALSE(make_solid_triangles(solid, 1e-7, 10'000, mesh));
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
