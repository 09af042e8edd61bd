#include <gtest/gtest.h>

#include "csg_random_trees.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::all_hits;
using testing::compiled;
using testing::kEvaluators;
using testing::SceneMaker;

Material clear(const char* name) {
    Material m;
    m.name = name;
    m.transmissive.color = {1, 1, 1};
    return m;
}

struct Walls {
    std::vector<double> t;
    std::vector<SurfaceMedia> media;
};

Walls walls(const Scene& scene, const Ray& ray) {
    Walls found;
    for (const Hit& hit : all_hits(scene, ray)) {
        found.t.push_back(hit.t);
        found.media.push_back(surface_at(*scene.aggregate, ray, hit).media);
    }
    return found;
}

/// Glass from 0 to 2 and a liquid from 1 to 3 on the x axis, glass listed first; behind them an
/// opaque core from 2.5 to 4.
SceneMaker tank() {
    SceneMaker maker;
    const MaterialId glass = maker.material(clear("glass"));
    const MaterialId liquid = maker.material(clear("liquid"));
    const MaterialId core = maker.material({.name = "core"});
    const ObjectIndex o = maker.object("tank");
    maker.description().objects[static_cast<std::size_t>(o)].combine = Combine::Union;
    maker.add(BoxShape{{0, -1, -1}, {2, 1, 1}}, glass, {}, o);
    maker.add(BoxShape{{2.5, -1, -1}, {4, 1, 1}}, core, {}, o);
    maker.add(BoxShape{{1, -1, -1}, {3, 1, 1}}, liquid, {}, o);
    maker.add(o);
    return maker;
}

TEST(CsgMedia, WallsBetweenMediaAreSurfacesWithBothSidesKnown) {
    for (const char* evaluator : kEvaluators) {
        SceneMaker maker = tank();
        const Scene scene = compiled(maker, evaluator);
        const Walls w = walls(scene, {{-1, 0.1, 0.2}, {1, 0, 0}});
        // The first listed solid fills an overlap; interfaces count twice, as exit and entry.
        EXPECT_EQ(w.t, (std::vector<double>{1, 3, 3, 3.5, 3.5, 5}));
        const std::optional<MaterialId> none, glass{MaterialId{0}}, liquid{MaterialId{1}},
            core{MaterialId{2}};
        const std::optional<MaterialId> expected[] = {none, glass, liquid, core, none};
        const std::size_t first_of[] = {0, 1, 3, 5};
        for (std::size_t i = 0; i < 4; ++i) {
            const SurfaceMedia& media = w.media.at(first_of[i]);
            EXPECT_TRUE(media.known);
            EXPECT_EQ(media.before, expected[i]) << i;
            EXPECT_EQ(media.after, expected[i + 1]) << i;
        }
        const Ray ray{{2.1, 0, 0}, {1, 0, 0}};
        Hit hit;
        ASSERT_TRUE(scene.aggregate->closest(ray, hit, nullptr));
        EXPECT_EQ(surface_at(*scene.aggregate, ray, hit).materials[0], MaterialId{2})
            << "an opaque core shows its own material";
        std::vector<Hit> crossings;
        EXPECT_TRUE(scene.aggregate->shadowed(ray, crossings, nullptr));
        crossings.clear();
        EXPECT_FALSE(scene.aggregate->shadowed({{1, -5, 0}, {0, 1, 0}}, crossings, nullptr));
        EXPECT_EQ(crossings.size(), 2u);
    }
}

TEST(CsgMedia, CoincidentWallsAreOneHoweverTheyRound) {
    for (const char* evaluator : kEvaluators) {
        RandomStream random(11);
        for (int i = 0; i < 100; ++i) {
            // A drinking glass: a cylinder minus its hollow; the liquid fills the hollow exactly.
            const Affine turned =
                Affine::rotate({random.uniform(-1, 1), 1, 0.5}, random.uniform(0, 6));
            const double r = random.uniform(0.5, 0.9);
            SceneMaker maker;
            const MaterialId glass = maker.material(clear("glass"));
            const MaterialId water = maker.material(clear("water"));
            const ObjectIndex cup = maker.object("cup");
            const ObjectIndex both = maker.object("both");
            auto& objects = maker.description().objects;
            objects[static_cast<std::size_t>(cup)].combine = Combine::Difference;
            objects[static_cast<std::size_t>(both)].combine = Combine::Union;
            maker.add(Cylinder{.base = {0, 0, -1}, .top = {0, 0, 1}}, glass, {}, cup);
            maker.add(Cylinder{.base = {0, 0, -0.9}, .top = {0, 0, 1.5}, .radius = r}, glass, {},
                      cup);
            maker.add(cup, glass, turned, both);
            maker.add(Cylinder{.base = {0, 0, -0.9}, .top = {0, 0, 0.5}, .radius = r}, water,
                      turned, both);
            maker.add(both);
            const Scene scene = compiled(maker, evaluator);
            const Vec3 origin =
                turned.point({-3, random.uniform(-0.4, 0.4), random.uniform(-0.8, 0.4)});
            const Walls w = walls(scene, {origin, turned.vector({1, 0, 0})});
            ASSERT_EQ(w.t.size(), 6u)
                << i;  // entry, glass to water and back with two crossings each, exit
            EXPECT_EQ(w.media[1].before, glass);
            EXPECT_EQ(w.media[1].after, water);
            EXPECT_EQ(w.media[3].before, water);
            EXPECT_EQ(w.media[3].after, glass);
        }
    }
}

TEST(CsgMedia, ACutMayShowWhatItCuts) {
    for (const char* evaluator : kEvaluators) {
        for (const CutMaterial cut : {CutMaterial::Own, CutMaterial::Minuend}) {
            SceneMaker maker;
            const MaterialId left = maker.material({.name = "left"});
            const MaterialId right = maker.material({.name = "right"});
            const MaterialId tool = maker.material({.name = "tool"});
            const ObjectIndex body = maker.object("body");
            const ObjectIndex d = maker.object("drilled");
            auto& objects = maker.description().objects;
            objects[static_cast<std::size_t>(body)].combine = Combine::Union;
            objects[static_cast<std::size_t>(d)].combine = Combine::Difference;
            objects[static_cast<std::size_t>(d)].cut_material = cut;
            maker.add(BoxShape{{-2, -1, -1}, {0, 1, 1}}, left, {}, body);
            maker.add(BoxShape{{0, -1, -1}, {2, 1, 1}}, right, {}, body);
            maker.add(body, tool, {}, d);
            maker.add(Sphere{{0, 0, 1}, 0.5}, tool, {}, d);
            maker.add(d);
            const Scene scene = compiled(maker, evaluator);
            for (const double x : {-0.2, 0.2}) {
                const Ray down{{x, 0, 5}, {0, 0, -1}};
                Hit hit;
                ASSERT_TRUE(scene.aggregate->closest(down, hit, nullptr));
                EXPECT_LT(hit.t, 4.5);
                EXPECT_GT(hit.t, 4.2);
                EXPECT_EQ(surface_at(*scene.aggregate, down, hit).materials[0],
                          cut == CutMaterial::Own ? tool
                          : x < 0                 ? left
                                                  : right);
            }
            EXPECT_EQ(all_hits(scene, {{-5, 0, 0}, {1, 0, 0}}).size(), 2u) << "no wall inside";
        }
    }
}

/// A turned glass of that radius around the z axis, with liquid in it.
Scene turned_glass(double radius, const char* evaluator) {
    SceneMaker maker;
    const MaterialId glass = maker.material(clear("glass"));
    const MaterialId liquid = maker.material(clear("liquid"));
    const ObjectIndex o = maker.object("filled");
    maker.description().objects[static_cast<std::size_t>(o)].combine = Combine::Union;
    Lathe wall;
    wall.profile.curves = {line_curve({0, -1}, {radius, -1}), line_curve({radius, -1}, {radius, 1}),
                           line_curve({radius, 1}, {0, 1})};
    wall.profile.loop_ends = {3};
    Diagnostics diagnostics;
    wall.validate({}, diagnostics);
    EXPECT_EQ(diagnostics.error_count(), 0u);
    // First listed: it fills what both hold.
    maker.add(Sphere{{0, 0, 0}, 0.25}, liquid, {}, o);
    maker.add(wall, glass, {}, o);
    maker.add(o);
    return compiled(maker, evaluator);
}

TEST(CsgMedia, CrossingsOfASolidThatIsGoneAreNotTakenForThoseOfTheNext) {
    // The same lines through solids that may reuse the address of an earlier one.
    const Ray line{{-4, 0, 0}, {1, 0, 0}};
    for (const char* evaluator : kEvaluators) {
        for (const double radius : {1.0, 0.5, 2.0, 0.75}) {
            const Scene scene = turned_glass(radius, evaluator);
            for (int again = 0; again < 2; ++again) {
                const Walls found = walls(scene, line);
                const double expected[] = {4 - radius, 3.75, 3.75, 4.25, 4.25, 4 + radius};
                ASSERT_EQ(found.t.size(), 6u) << evaluator << radius;
                for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(found.t[i], expected[i], 1e-12);
                EXPECT_EQ(found.media[0].before, std::nullopt);
                EXPECT_EQ(found.media[0].after, MaterialId{0});
                EXPECT_EQ(found.media[1].after, MaterialId{1});
                EXPECT_EQ(found.media[5].after, std::nullopt);
            }
        }
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
