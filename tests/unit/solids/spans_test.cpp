#include "alhazen/solids/spans.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/box_mesh.h"
#include "support/random.h"
#include "support/scene_maker.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::box_mesh;
using testing::Random;
using testing::SceneMaker;

constexpr double kInf = std::numeric_limits<double>::infinity();

std::vector<std::pair<double, double>> times(const SpanList& list) {
    std::vector<std::pair<double, double>> t;
    for (const SolidSpan& span : list.spans) t.emplace_back(span.entry.t, span.exit.t);
    return t;
}

TEST(Spans, ARayThroughTwoSolidsHasOneOfEachInOrder) {
    SceneMaker maker;
    const MaterialId red = maker.material({}), blue = maker.material({});
    maker.add(Sphere{{0, 0, 0}, 1}, red);
    maker.add(BoxShape{{0.5, -1, -1}, {3, 1, 1}}, blue);
    maker.add(Plane{});  // bounds no volume
    const Scene scene = maker.compile();
    const SolidQueries queries(scene.aggregate);
    EXPECT_EQ(queries.solids().count(), 2u);
    EXPECT_EQ(queries.solids().open_surfaces(), 1u);
    SpanList list;
    const Ray ray{{-4, 0, 0}, {2, 0, 0}};
    queries.spans(ray, list);
    ASSERT_EQ(times(list), (std::vector<std::pair<double, double>>{{1.5, 2.5}, {2.25, 3.5}}));
    EXPECT_EQ(list.spans[0].solid, SolidId{0});
    EXPECT_EQ(list.spans[1].solid, SolidId{1});
    const SpanSurface in = queries.entry_surface(ray, list.spans[1]);
    EXPECT_EQ(in.point, (Vec3{0.5, 0, 0}));
    EXPECT_EQ(in.normal, (Vec3{-1, 0, 0}));
    EXPECT_EQ(in.material, blue);
    EXPECT_EQ(queries.exit_surface(ray, list.spans[0]).normal, (Vec3{1, 0, 0}));
    const Thickness thickness = queries.thickness(ray, list);
    EXPECT_EQ(thickness.inside_any, 4.0);
    ASSERT_EQ(thickness.of_solid.size(), 2u);
    EXPECT_EQ(thickness.of_solid[0].length, 2.0);
    EXPECT_EQ(thickness.of_solid[1].length, 2.5);
}

TEST(Spans, ARayThatStartsOrEndsInsideSaysSo) {
    SceneMaker maker;
    maker.add(Sphere{{0, 0, 0}, 2});
    const Scene scene = maker.compile();
    const SolidQueries queries(scene.aggregate);
    SpanList list;
    queries.spans({{0, 0, 0}, {1, 0, 0}}, list);
    ASSERT_EQ(times(list), (std::vector<std::pair<double, double>>{{0, 2}}));
    EXPECT_FALSE(list.spans[0].entry.is_crossing);
    EXPECT_TRUE(list.spans[0].exit.is_crossing);
    queries.spans({{0, 0, 0}, {1, 0, 0}, -1, 1}, list);
    ASSERT_EQ(times(list), (std::vector<std::pair<double, double>>{{-1, 1}}));
    EXPECT_FALSE(list.spans[0].exit.is_crossing);
    EXPECT_EQ(queries.entry_surface({{0, 0, 0}, {1, 0, 0}, -1, 1}, list.spans[0]).point,
              (Vec3{-1, 0, 0}));
    queries.spans({{0, 0, 0}, {1, 0, 0}, 2, 9}, list);
    EXPECT_TRUE(list.spans.empty());
    queries.spans({{0, 0, 0}, {0, 0, 0}}, list);
    EXPECT_TRUE(list.spans.empty());
}

TEST(Spans, ATangentBeginsNoSpanAndEndsNone) {
    SceneMaker maker;
    maker.add(Sphere{{0, 0, 0}, 1});
    const Scene scene = maker.compile();
    SpanList list;
    SolidQueries(scene.aggregate).spans({{-5, 1, 0}, {1, 0, 0}}, list);
    EXPECT_TRUE(list.spans.empty());
    EXPECT_TRUE(list.inconsistent.empty());
}

TEST(Spans, MeshesShapesAndInstancesOfInstancesAreToldApart) {
    SceneMaker maker;
    const ObjectIndex pair = maker.object("pair"), row = maker.object("row");
    maker.add(Sphere{{0, 0, 0}, 1}, MaterialId{0}, {}, pair);
    maker.add(maker.mesh(box_mesh({{2, -1, -1}, {3, 1, 1}})), MaterialId{0}, {}, pair);
    for (int i = 0; i < 3; ++i) {
        maker.add(pair, MaterialId{0}, Affine::translate({10.0 * i, 0, 0}), row);
    }
    maker.add(row);
    maker.add(row, MaterialId{0}, Affine::translate({0, 100, 0}));
    maker.add(BoxShape{{-4, -1, -1}, {-3, 1, 1}});
    const Scene scene = maker.compile("wide_bvh");
    const SolidQueries queries(scene.aggregate);
    ASSERT_EQ(queries.solids().count(), 13u);
    SpanList list;
    queries.spans({{-5, 0.25, 0.125}, {1, 0, 0}}, list);
    ASSERT_EQ(list.spans.size(), 7u);
    for (std::size_t i = 0; i < list.spans.size(); ++i) {
        EXPECT_EQ(list.spans[i].solid, SolidId{i}) << i;
    }
    EXPECT_NEAR(list.spans[6].entry.t, 27, 1e-12);
    EXPECT_NEAR(list.spans[6].exit.t, 28, 1e-12);
    for (std::uint64_t i = 0; i < 13; ++i) {
        const SolidPlace place = queries.solids().place(SolidId{i});
        const bool mesh = place.kind == SolidPlace::Kind::Mesh;
        EXPECT_EQ(mesh, i > 0 && i % 2 == 0) << i;
        const Vec3 at = place.world.outer_from_inner.point({0, 0, 0});
        if (i > 0) {
            EXPECT_EQ(at, (Vec3{10.0 * int((i - 1) / 2 % 3), i > 6 ? 100.0 : 0.0, 0})) << i;
        }
        EXPECT_EQ(place.parts.size(), i == 0 ? 1u : 3u) << i;
    }
}

TEST(Spans, MergedSpansOfAllAcceleratorsAreTheSame) {
    Random random(11);
    for (int round = 0; round < 20; ++round) {
        SceneMaker maker;
        for (int i = 0; i < 12; ++i) {
            maker.add(Sphere{random.in_cube(3), random.uniform(0.2, 2)});
            const Vec3 lo = random.on_lattice(2, 0.5);
            maker.add(BoxShape{lo, lo + Vec3{1, 0.5, 1.5}}, MaterialId{0},
                      Affine::rotate(random.unit_vector(), random.uniform(0, 6)));
        }
        const SolidQueries list_queries(maker.compile("list").aggregate);
        const SolidQueries wide_queries(maker.compile("wide_bvh").aggregate);
        std::vector<Ray> rays;
        for (int i = 0; i < 600; ++i) {
            rays.push_back({random.in_cube(4), random.unit_vector(), random.uniform(-5, 0), 3});
        }
        SpanLists a, b;
        list_queries.spans(rays, a);
        wide_queries.spans(rays, b);
        ASSERT_EQ(a.ends, b.ends);
        EXPECT_EQ(a.inconsistent, 0u);
        SpanList one;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            list_queries.spans(rays[i], one);
            ASSERT_EQ(a.of(i).size(), one.spans.size());
            for (std::size_t k = 0; k < one.spans.size(); ++k) {
                ASSERT_EQ(a.of(i)[k].entry.t, b.of(i)[k].entry.t) << "round " << round;
                ASSERT_EQ(a.of(i)[k].exit.t, b.of(i)[k].exit.t) << "round " << round;
                ASSERT_EQ(a.of(i)[k].solid, b.of(i)[k].solid) << "round " << round;
                ASSERT_EQ(a.of(i)[k].exit.t, one.spans[k].exit.t);
            }
        }
    }
}

TEST(Inside, PointsOfRandomSolidsAreWhereTheirFormulasSay) {
    Random random(5);
    SceneMaker maker;
    maker.add(Sphere{{1, 0, 0}, 2});
    maker.add(BoxShape{{-1, -1, -1}, {1, 2, 1}});
    maker.add(Cylinder{{0, 0, -2}, {0, 0, 2}, 1.5});
    maker.add(Cone{{0, 0, 0}, {0, 0, 3}, 2, 0});
    maker.add(maker.mesh(box_mesh({{0, 0, 0}, {2, 2, 2}})));
    const SolidQueries queries(maker.compile("wide_bvh").aggregate);
    std::vector<Vec3> points;
    for (int i = 0; i < 4000; ++i) points.push_back(random.in_cube(3.5));
    const auto found = queries.inside(points);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Vec3& p = points[i];
        const double across = std::hypot(p.x, p.y);
        const bool expected[5] = {
            length(p - Vec3{1, 0, 0}) < 2, Box3{{-1, -1, -1}, {1, 2, 1}}.contains(p),
            across < 1.5 && std::abs(p.z) < 2, p.z > 0 && across < 2 * (1 - p.z / 3),
            Box3{{0, 0, 0}, {2, 2, 2}}.contains(p)};
        std::vector<Containment> wanted;
        for (std::uint64_t s = 0; s < 5; ++s) {
            if (expected[s]) wanted.push_back({SolidId{s}, false});
        }
        ASSERT_EQ(found[i], wanted) << p.x << " " << p.y << " " << p.z;
    }
}

TEST(Inside, PointsOnFacesEdgesAndCornersOfABoxBelongToItAndSaySo) {
    SceneMaker maker;
    maker.add(BoxShape{{-1, -2, -3}, {1, 2, 3}});
    maker.add(maker.mesh(box_mesh({{-1, -2, -3}, {1, 2, 3}})), MaterialId{0},
              Affine::translate({100, 0, 0}));
    const SolidQueries queries(maker.compile().aggregate);
    for (const double offset : {0.0, 100.0}) {
        const SolidId solid{offset == 0.0 ? 0u : 1u};
        for (int i = 0; i < 27; ++i) {
            const Vec3 side{i % 3 - 1.0, i / 3 % 3 - 1.0, i / 9 - 1.0};
            const Vec3 p = Vec3{offset, 0, 0} + side * Vec3{1, 2, 3};
            const bool middle = side == Vec3{};
            EXPECT_EQ(queries.inside(p), (std::vector<Containment>{{solid, !middle}}))
                << "corner " << i << " offset " << offset;
            const Vec3 beyond = Vec3{offset, 0, 0} + 1.001 * side * Vec3{1, 2, 3};
            if (!middle) {
                EXPECT_TRUE(queries.inside(beyond).empty());
            }
        }
    }
    EXPECT_TRUE(queries.inside({kInf, 0, 0}).empty());
}

TEST(Inside, PointsOnCurvedSurfacesAreOnThemWhateverThePlacement) {
    Random random(9);
    for (int round = 0; round < 30; ++round) {
        SceneMaker maker;
        const Vec3 center = random.in_cube(50);
        const double radius = random.log_uniform(0.01, 100);
        maker.add(Sphere{{0, 0, 0}, radius}, MaterialId{0}, Affine::translate(center));
        const SolidQueries queries(maker.compile().aggregate);
        for (int i = 0; i < 50; ++i) {
            const Vec3 n = random.unit_vector();
            const std::vector<Containment> on{{SolidId{0}, true}};
            ASSERT_EQ(queries.inside(center + radius * n), on) << "round " << round;
            ASSERT_TRUE(queries.inside(center + 1.0001 * radius * n).empty());
            const std::vector<Containment> in{{SolidId{0}, false}};
            ASSERT_EQ(queries.inside(center + 0.9999 * radius * n), in);
        }
    }
}

TEST(Spans, DirectionsOfAnyLengthMeetTheSame) {
    SceneMaker maker;
    const ObjectIndex object = maker.object("object"), cut = maker.object("cut");
    maker.description().objects.back().combine = Combine::Difference;
    maker.add(Sphere{{0, 0, 0}, 1}, MaterialId{0}, {}, object);
    maker.add(BoxShape{{-2, -2, -2}, {2, 2, 2}}, MaterialId{0}, {}, cut);
    maker.add(Sphere{{0, 0, 0}, 1}, MaterialId{0}, {}, cut);
    maker.add(object, MaterialId{0}, Affine::rotate({1, 2, 3}, 0.7));
    maker.add(object, MaterialId{0}, Affine::translate({30, 0, 0}));
    maker.add(cut, MaterialId{0}, Affine::translate({5, 0, 0}));
    maker.add(Torus{}, MaterialId{0}, Affine::translate({10, 0, 0}));
    maker.add(Algebraic{}, MaterialId{0}, Affine::translate({15, 0, 0}));
    maker.add(maker.mesh(box_mesh({{19, -1, -1}, {21, 1, 1}})));
    for (const char* accelerator : {"list", "wide_bvh"}) {
        const Scene scene = maker.compile(accelerator);
        const SolidQueries queries(scene.aggregate);
        SpanList usual, list;
        const Ray ray{{-9, 0.25, 0.125}, {1, 0.0009765625, 0}, 1, 64};
        queries.spans(ray, usual);
        ASSERT_GE(usual.spans.size(), 8u);
        const double usual_thickness = queries.thickness(ray, list).inside_any;
        for (const int exponent : {-1010, -700, -531, -41, 41, 500, 531, 1000}) {
            const Ray scaled{ray.origin,
                             {std::ldexp(1.0, exponent), std::ldexp(0.0009765625, exponent), 0},
                             std::ldexp(1.0, -exponent),
                             std::ldexp(64.0, -exponent)};
            queries.spans(scaled, list);
            ASSERT_EQ(list.spans.size(), usual.spans.size()) << exponent;
            for (std::size_t i = 0; i < list.spans.size(); ++i) {
                const SolidSpan &a = list.spans[i], &b = usual.spans[i];
                EXPECT_EQ(a.solid, b.solid);
                EXPECT_EQ(a.entry.t, std::ldexp(b.entry.t, -exponent)) << exponent;
                EXPECT_EQ(a.exit.t, std::ldexp(b.exit.t, -exponent)) << exponent;
                EXPECT_EQ(queries.entry_surface(scaled, a).normal,
                          queries.entry_surface(ray, b).normal);
                EXPECT_EQ(queries.exit_surface(scaled, a).point,
                          queries.exit_surface(ray, b).point);
            }
            EXPECT_EQ(queries.thickness(scaled, list).inside_any, usual_thickness);
        }
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
