/// Boxes leave out no hit, and the order, the paths and the shadows are those of the list.

#include "alhazen/verification/brute_force.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <utility>
#include <vector>

#include "alhazen/verification/verify.h"
#include "alhazen/verification/verify_rays.h"
#include "support/random.h"
#include "support/scene_maker.h"
#include "support/sphere_mesh.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::Random;
using testing::SceneMaker;

TriangleMesh fine_ball(int levels) {
    testing::SphereMesh sphere(levels);
    TriangleMesh mesh;
    mesh.positions = std::move(sphere.positions);
    mesh.triangles = std::move(sphere.triangles);
    return mesh;
}

/// Triangles in no order: boxes of neighbours in the file overlap.
TriangleMesh confetti(int count) {
    Random random(11);
    TriangleMesh mesh;
    for (int i = 0; i < count; ++i) {
        const Vec3 middle = random.in_cube(5);
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        for (int k = 0; k < 3; ++k) mesh.positions.push_back(middle + 0.2 * random.unit_vector());
        mesh.triangles.push_back({first, first + 1, first + 2});
    }
    return mesh;
}

bool same(const std::vector<Hit>& a, const std::vector<Hit>& b) {
    return std::ranges::equal(a, b, [](const Hit& x, const Hit& y) {
        return x.t == y.t && x.u == y.u && x.v == y.v && x.part == y.part &&
               x.primitive == y.primitive && x.path == y.path;
    });
}

TEST(BruteForce, FindsWhatTheListFinds) {
    const std::pair<const char*, std::function<void(SceneMaker&)>> cases[] = {
        {"ball", [](SceneMaker& maker) { maker.add(maker.mesh(fine_ball(5))); }},
        {"confetti", [](SceneMaker& maker) { maker.add(maker.mesh(confetti(5000))); }},
        {"far from the origin",
         [](SceneMaker& maker) {
             maker.add(maker.mesh(fine_ball(4)), MaterialId{0},
                       Affine::translate({1e7, -3e6, 1e5}));
         }},
        {"tiny beside huge",
         [](SceneMaker& maker) {
             maker.add(maker.mesh(fine_ball(4)));
             maker.add(maker.mesh(fine_ball(3)), MaterialId{0}, Affine::scale({1e5, 1e5, 1}));
         }},
        {"flat",
         [](SceneMaker& maker) {
             maker.add(maker.mesh(confetti(500)), MaterialId{0}, Affine::scale({1, 1, 1e-12}));
         }},
        {"instances",
         [](SceneMaker& maker) {
             const ObjectIndex inner = maker.object("inner");
             maker.add(maker.mesh(fine_ball(3)), MaterialId{0}, {}, inner);
             const ObjectIndex outer = maker.object("outer");
             Random random(5);
             for (int i = 0; i < 6; ++i) {
                 maker.add(inner, MaterialId{0},
                           Affine::translate(random.in_cube(3)) *
                               Affine::rotate(random.unit_vector(), 1.0 + i),
                           outer);
             }
             maker.add(Sphere{{2, 0, 0}, 1}, MaterialId{0}, {}, outer);
             maker.add(outer);
             maker.add(outer, MaterialId{0}, Affine::scale({1e-3, 2, 1}));
             maker.add(Plane{.point = {0, 0, -3}});
             maker.description().objects[0].parts[1].visible_to = mask_of(RayKind::Shadow);
         }},
        {"many spheres",
         [](SceneMaker& maker) {
             Random random(6);
             for (std::size_t i = 0; i < BruteForce::kMostPlain + 100; ++i) {
                 maker.add(Sphere{random.in_cube(20), random.uniform(0.1, 0.6)});
             }
         }},
    };
    for (const auto& [name, add] : cases) {
        SceneMaker maker;
        Material glass;
        glass.transmissive.color = {0.5, 0.5, 0.5};
        (void)maker.material(glass);
        add(maker);
        const Scene scene = maker.compile("list");
        const Aggregate& list = *scene.aggregate;
        const BruteForce brute(list);
        EXPECT_EQ(brute.believed_boxes() > 0, std::string(name) == "many spheres");
        VerifyRays rays(list.box(), &scene.cameras.front().camera, list.primitives(), 3);
        constexpr std::size_t kRays = 400;
        std::vector<std::vector<Hit>> found(kRays);
        std::vector<BruteForce::Shot> shots;
        for (std::size_t i = 0; i < kRays; ++i) {
            Ray ray = rays.next().ray;
            // Some from very far, some that are no rays.
            if (i % 50 == 0) ray.origin = ray.origin - 1e9 * ray.direction;
            if (i % 97 == 0) ray.direction = {};
            const RayMask mask = i % 3 == 0 ? mask_of(RayKind::Eye) : kAllRays;
            shots.push_back({ray, mask, &found[i]});
        }
        brute.all_hits(shots);
        std::size_t hits = 0;
        for (std::size_t i = 0; i < kRays; ++i) {
            std::vector<Hit> expected, crossings, tints;
            list.all_hits(shots[i].ray, expected, {nullptr, shots[i].mask});
            ASSERT_TRUE(same(found[i], expected)) << name << ", ray " << i;
            const bool shadow = list.shadowed(shots[i].ray, crossings, {nullptr, shots[i].mask});
            ASSERT_EQ(brute.shadowed(shots[i].ray, shots[i].mask, found[i], tints), shadow);
            if (!shadow) {
                ASSERT_TRUE(same(tints, crossings)) << name << ", ray " << i;
            }
            hits += expected.size();
        }
        EXPECT_GT(hits, 40u) << name;
    }
}

TEST(Verify, TheReportTellsWhatWasLeftOut) {
    SceneMaker maker;
    TriangleMesh open = testing::tetrahedron();
    open.triangles.pop_back();
    maker.add(maker.mesh(std::move(open)));
    maker.add(maker.mesh(fine_ball(3)));
    for (int i = 0; i < 70; ++i) maker.add(Sphere{{3.0 * i, 0, 0}, 1});
    maker.add(Disc{});
    (void)maker.compile();
    VerifyOptions options;
    options.rays = 3000;
    options.accelerator = "list";
    options.most_list_tests = 100'000;
    const VerifyReport report = verify(maker.description(), options);
    EXPECT_TRUE(report.holds());
    EXPECT_GT(report.rays, 100u);
    EXPECT_LT(report.rays, 1000u);
    EXPECT_EQ(report.rays + report.rays_left_out, 3000u);
    EXPECT_EQ(report.open_meshes, 1u);
    EXPECT_EQ(report.shapes_left_out, 7u);
    EXPECT_EQ(report.believed_boxes, 0u);
}

/// Records its input.
class Recorder final : public ProgressSink {
  public:
    void update(std::string_view phase, std::size_t done, std::size_t total) override {
        if (phases.empty() || phases.back().first != phase)
            phases.push_back({std::string(phase), 0});
        EXPECT_GE(done, phases.back().second);
        EXPECT_LE(done, total);
        phases.back().second = done;
        if (done == total) ++completed;
    }
    std::vector<std::pair<std::string, std::size_t>> phases;
    int completed = 0;
};

TEST(Verify, ProgressReachesTheEndOfEachPhase) {
    SceneMaker maker;
    maker.add(maker.mesh(fine_ball(3)));
    (void)maker.compile();
    Recorder recorder;
    VerifyOptions options;
    options.rays = 5000;
    options.progress = &recorder;
    EXPECT_TRUE(verify(maker.description(), options).holds());
    ASSERT_EQ(recorder.phases.size(), 3u);
    EXPECT_EQ(recorder.completed, 3);
    EXPECT_EQ(recorder.phases[1], (std::pair<std::string, std::size_t>{"verify wide_bvh", 10000}));
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
