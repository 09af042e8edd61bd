#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <sstream>

#include "alhazen/aggregates/accelerator_table.h"
#include "alhazen/aggregates/wide_bvh/stream_override.h"
#include "alhazen/aggregates/wide_bvh/wide_bvh_aggregate.h"
#include "alhazen/parallel/parallel.h"
#include "alhazen/simd/targets.h"
#include "unit/aggregates/compare_aggregates.h"
#include "unit/aggregates/conformance_scenes.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

/// Batches of small trees test the stream.
const StreamOverride kStreams;

using namespace testing;

/// Batches have the results of single queries.
void compare_batches(const Aggregate& tested, const std::vector<Ray>& rays,
                     const std::vector<Answer>& answers, const std::string& name) {
    std::vector<Hit> hits(rays.size());
    tested.closest_batch(rays, hits, nullptr);
    const auto occluded = std::make_unique<bool[]>(rays.size());
    tested.occluded_batch(rays, {occluded.get(), rays.size()}, nullptr);
    TraversalStats stats;
    std::vector<Hit> counted(rays.size());
    tested.closest_batch(rays, counted, &stats);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        ASSERT_TRUE(same(hits[i], answers[i].closest))
            << name << ", ray " << i << ": " << show(rays[i]) << ": " << show(answers[i].closest)
            << " became " << show(hits[i]);
        ASSERT_EQ(occluded[i], answers[i].occluded) << name << ", ray " << i;
        ASSERT_TRUE(same(counted[i], hits[i])) << name << ", ray " << i;
    }
}

/// Compares with the list on `count` rays, on every instruction set.
void compare(const std::string& name, const PrimitiveTable& table, const MakeRay& make_ray,
             int count = 2000) {
    const auto list = make_aggregate("list", table);
    RandomEngine random(7);
    std::vector<Ray> rays;
    std::vector<Answer> answers;
    int hits = 0;
    for (int i = 0; i < count; ++i) {
        rays.push_back(make_ray(random));
        answers.push_back(ask(*list, rays.back()));
        hits += answers.back().found;
    }
    // Guards against comparing only misses.
    EXPECT_TRUE(table.size() == 0 || hits > 0) << name;
    for (const std::string& target : simd_targets()) {
        const SimdTargetOverride use(target);
        const auto tested = make_aggregate("wide_bvh", table);
        EXPECT_EQ(list->box(), tested->box()) << name;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            ASSERT_EQ(difference(answers[i], ask(*tested, rays[i])), "")
                << name << " on " << target << ", ray " << i << ": " << show(rays[i]);
        }
        compare_batches(*tested, rays, answers, name + " on " + target);
    }
}

TEST(WideBvh, SingleSidedTrianglesShadowAsTheListSays) {
    PrimitiveTable table = random_triangles(300, 1, 0.6, 31);
    ASSERT_FALSE(table.meshes.empty());
    table.meshes[0].material = MaterialId{2};
    table.material_opacity = {Opacity::Opaque, Opacity::Transparent, Opacity::OpaqueFromFront};
    compare("single-sided", table, random_rays(1));
    table.meshes[0].mirrored = true;
    compare("mirrored and single-sided", table, random_rays(1));
}

TEST(WideBvh, TrianglesWithTwoEqualVerticesAreInNoTree) {
    TableBuilder builder;
    const Vec3 a{0, 0, 0}, b{1, 0, 0}, c{0, 1, 0};
    builder.add_triangle(a, b, c);
    for (int i = 0; i < 1000; ++i) builder.add_triangle(a, a, i % 2 == 0 ? a : b);
    const PrimitiveTable table = builder.finish();
    compare("without area", table, random_rays(1));
    TraversalStats stats;
    Hit hit;
    const Ray ray{{0.25, 0.25, 1}, {0, 0, -1}, 0, std::numeric_limits<double>::infinity()};
    EXPECT_TRUE(make_aggregate("wide_bvh", table)->closest(ray, hit, &stats));
    EXPECT_LT(stats.primitive_tests, 100u);
}

TEST(WideBvh, FindsTheHitsOfBruteForceAmongRandomTriangles) {
    for (const int count : {2, 3, 8, 9, 17, 100, 1000}) {
        compare(std::to_string(count) + " triangles", random_triangles(count, 1, 0.3, 11),
                random_rays(1), 1000);
    }
}

TEST(WideBvh, CornersThatFloatHoldsAndOthersAreDecidedTogether) {
    // A stream decides eight rays together. Blocks hold corners exactly where they are on the grid;
    // the others come from the mesh.
    const auto on_grid = [](const Vec3& p) {
        const auto snap = [](double x) { return std::round(x * 1024) / 1024; };
        return Vec3{snap(p.x), snap(p.y), snap(p.z)};
    };
    for (const Vec3& middle : {Vec3{}, Vec3{96, 32, -64}}) {
        for (const int every : {1, 2, 5}) {
            RandomEngine random(23);
            TableBuilder builder;
            for (int i = 0; i < 400; ++i) {
                Vec3 p[3] = {uniform_point(random, 1), {}, {}};
                p[1] = p[0] + uniform_point(random, 0.3), p[2] = p[0] + uniform_point(random, 0.3);
                for (Vec3& corner : p)
                    corner = middle + (i % every == 0 ? on_grid(corner) : corner);
                builder.add_triangle(p[0], p[1], p[2]);
            }
            const MakeRay around = random_rays(1);
            const auto make_ray = [&](RandomEngine& engine) {
                Ray ray = around(engine);
                ray.origin += middle;
                // Two components of the same size, or of the same float: no axis is dominant.
                if (engine() % 4 == 0) ray.direction.y = -ray.direction.x;
                if (engine() % 4 == 0) ray.direction.z = ray.direction.x * (1 + 0x1p-40);
                return ray;
            };
            compare("corners, every " + std::to_string(every) + " on the grid", builder.finish(),
                    make_ray);
        }
    }
}

TEST(WideBvh, FindsTheHitsOfBruteForceAmongRandomSpheres) {
    for (const int count : {2, 9, 300}) {
        compare(std::to_string(count) + " spheres", random_spheres(count, 1, 0.2, 12),
                random_rays(1), 1000);
    }
}

TEST(WideBvh, FindsTheHitsOfBruteForceInAMixtureWithPlanes) {
    for (const int count : {1, 7, 40, 400}) {
        compare(std::to_string(count) + " primitives", random_mixture(count, 1, 0.3, 13),
                random_rays(1), 1000);
    }
}

TEST(WideBvh, FindsTheHitsOfBruteForceOnALattice) {
    RandomEngine random(14);
    TableBuilder builder;
    for (int i = 0; i < 600; ++i) {
        const Vec3 a = lattice_point(random, 3);
        builder.add_triangle(a, a + lattice_point(random, 1), a + lattice_point(random, 1),
                             random() % 2 == 0);
        if (i % 4 == 0) builder.add_sphere(a, uniform_int(random, 1, 2) * 0.5, random() % 2 == 0);
    }
    const PrimitiveTable table = builder.finish();
    compare("lattice, lattice rays", table, lattice_rays(3), 4000);
    compare("lattice, random rays", table, random_rays(3), 1000);
}

TEST(WideBvh, FindsTheHitsOfBruteForceOnAFlatGrid) {
    TableBuilder builder;
    for (int x = -8; x < 8; ++x) {
        for (int y = -8; y < 8; ++y) {
            const Vec3 p{double(x), double(y), 0};
            builder.add_triangle(p, p + Vec3{1, 0, 0}, p + Vec3{1, 1, 0});
            builder.add_triangle(p, p + Vec3{1, 1, 0}, p + Vec3{0, 1, 0});
        }
    }
    const PrimitiveTable table = builder.finish();
    compare("grid, lattice rays", table, lattice_rays(8), 4000);
    compare("grid, random rays", table, random_rays(8), 1000);
}

TEST(WideBvh, FindsTheLowestIdAmongCoincidentPrimitives) {
    TableBuilder builder;
    for (int i = 0; i < 200; ++i) {
        builder.add_triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, i > 100);
        builder.add_sphere({2, 0, 0}, 0.5, i > 100);
    }
    const PrimitiveTable table = builder.finish();
    compare("coincident", table, random_rays(1.5), 1000);
    const auto tree = make_aggregate("wide_bvh", table);
    Hit hit;
    ASSERT_TRUE(tree->closest({{0.25, 0.25, 1}, {0, 0, -1}}, hit, nullptr));
    EXPECT_EQ(hit.primitive, PrimitiveId{200});
}

TEST(WideBvh, FindsTheHitsOfBruteForceAtAnySize) {
    for (const double size : {1e-100, 1e-30, 1e-6, 1e6, 1e30, 1e100}) {
        std::ostringstream name;
        name << "scene of size " << size;
        compare(name.str() + ", triangles", random_triangles(200, size, 0.3 * size, 15),
                random_rays(size), 500);
        compare(name.str() + ", mixture", random_mixture(200, size, 0.3 * size, 15),
                random_rays(size), 500);
    }
}

TEST(WideBvh, FindsTheHitsOfBruteForceAmongNestedScales) {
    RandomEngine random(16);
    TableBuilder builder;
    for (double scale = 1e-6; scale < 2e6; scale *= 10) {
        for (int i = 0; i < 40; ++i) {
            const Vec3 a = uniform_point(random, scale);
            builder.add_triangle(a, a + uniform_point(random, scale),
                                 a + uniform_point(random, scale), random() % 2 == 0);
        }
    }
    const PrimitiveTable table = builder.finish();
    for (const double reach : {1e-6, 1e-2, 1.0, 1e6})
        compare("nested", table, random_rays(reach), 500);
}

TEST(WideBvh, TheTriangleThatFillsFreeLanesOccludesNothing) {
    TableBuilder builder;
    builder.add_triangle({-0.9, -0.9, -0.9}, {0.9, 0.9, 0.9}, {-0.9, 0.9, -0.9});
    const PrimitiveTable table = builder.finish();
    const auto rays = [](RandomEngine& random) {
        // Half of them aimed at it, from the scene and from outside.
        Ray ray{uniform_point(random, random() % 2 == 0 ? 1 : 40),
                {},
                0,
                std::numeric_limits<double>::infinity()};
        const Vec3 far{uniform(random, 40, 42), uniform(random, 45, 48), uniform(random, 50, 53)};
        ray.direction =
            random() % 2 == 0 ? far - ray.origin : uniform_point(random, 1) - ray.origin;
        if (random() % 4 == 0) ray.t_max = 100;
        return ray;
    };
    compare("one triangle", table, rays, 4000);
    Ray ray{{0.1, 0, 0}, {41, 140.0 / 3, 155.0 / 3}, 0, std::numeric_limits<double>::infinity()};
    for (const std::string& target : simd_targets()) {
        const SimdTargetOverride use(target);
        EXPECT_FALSE(make_aggregate("wide_bvh", table)->occluded(ray, nullptr)) << target;
    }
}

TEST(WideBvh, FindsTheHitsOfBruteForceWhereExponentsRunOut) {
    for (const double scale : {1e-149, 1e-120, 1e-104, 1e-61, 1e61, 1e103, 1e120, 1e149}) {
        RandomEngine random(33);
        TableBuilder builder;
        for (int i = 0; i < 40; ++i) {
            const Vec3 a = uniform_point(random, scale);
            builder.add_triangle(a, a + uniform_point(random, scale),
                                 a + uniform_point(random, scale), random() % 2 == 0);
        }
        const PrimitiveTable table = builder.finish();
        const auto list = make_aggregate("list", table);
        const auto tested = make_aggregate("wide_bvh", table);
        for (int i = 0; i < 2000; ++i) {
            Ray ray{2 * uniform_point(random, scale), {}, 0, 0};
            ray.direction = uniform_point(random, scale) - ray.origin;
            ray.t_max = random() % 2 == 0 ? std::numeric_limits<double>::infinity() : 1.0;
            if (random() % 2 == 0) ray.t_min = 1e-9;
            if (!is_valid(ray)) continue;
            ASSERT_EQ(difference(ask(*list, ray), ask(*tested, ray)), "")
                << "at a scale of " << scale << ": " << show(ray);
        }
    }
}

TEST(WideBvh, FindsTheHitsOfBruteForceFromFarAwayAndFarFromTheOrigin) {
    for (const double distance : {1e3, 1e6, 1e9, 1e12, 1e15, 1e30}) {
        const MakeRay rays = rays_from(distance);
        std::ostringstream name;
        name << "rays from " << distance;
        compare(name.str() + ", triangles", random_triangles(200, 1, 0.5, 17), rays, 500);
        compare(name.str() + ", mixture", random_mixture(200, 1, 0.5, 17), rays, 500);
    }
    RandomEngine random(18);
    TableBuilder builder;
    const Vec3 there{1e8, -3e8, 2e8};
    for (int i = 0; i < 300; ++i) {
        const Vec3 a = there + uniform_point(random, 1);
        builder.add_triangle(a, a + uniform_point(random, 0.3), a + uniform_point(random, 0.3));
        builder.add_sphere(a, 0.1);
    }
    const auto rays = [&there](RandomEngine& generator) {
        Ray ray{there + uniform_point(generator, 2), {}, 0, 1e300};
        ray.direction = there + uniform_point(generator, 1) - ray.origin;
        return ray;
    };
    compare("scene far from the origin", builder.finish(), rays, 1000);
}

TEST(WideBvh, FindsTheHitsOfBruteForceOnTrianglesSeenEdgeOn) {
    // Triangles and rays in a few common planes through the x axis, up to rounding: the edge
    // functions are rounding errors, and a hit computed from them could lie anywhere in its
    // triangle's plane.
    RandomEngine random(19);
    const auto across = [](RandomEngine& generator) {
        const double angle = 0.1 + static_cast<double>(generator() % 6);
        return Vec3{0, std::cos(angle), std::sin(angle)};
    };
    TableBuilder builder;
    for (int i = 0; i < 600; ++i) {
        const Vec3 plane = across(random);
        const Vec3 base = uniform(random, -1, 1) * plane;
        const auto corner = [&] {
            return base + Vec3{uniform(random, -1, 1), 0, 0} + uniform(random, 0, 0.2) * plane;
        };
        builder.add_triangle(corner(), corner(), corner(), random() % 2 == 0);
    }
    const auto rays = [&](RandomEngine& generator) {
        const Vec3 plane = across(generator);
        Ray ray{Vec3{-2, 0, 0} + uniform(generator, -1, 1) * plane, {}, 0, 1e300};
        ray.direction = Vec3{2 + uniform(generator, -1, 1), 0, 0} +
                        uniform(generator, -1, 1) * plane - (ray.origin - Vec3{-2, 0, 0});
        return ray;
    };
    compare("edge on", builder.finish(), rays, 6000);
}

TEST(WideBvh, HandlesNoneAndOnePrimitive) {
    compare("empty", TableBuilder{}.finish(), random_rays(1), 100);
    compare("one triangle", random_triangles(1, 0.1, 1, 20), random_rays(1), 2000);
    compare("one sphere", random_spheres(1, 0.1, 1, 20), random_rays(1), 2000);
    TableBuilder planes;
    planes.add_plane({0, 0, 0}, {0, 0, 1});
    compare("one plane", planes.finish(), random_rays(1), 1000);
    TableBuilder points;
    for (int i = 0; i < 100; ++i) points.add_triangle({0, 0, 0}, {0, 0, 0}, {0, 0, 0});
    points.add_sphere({0, 0, 0}, 0.5);
    compare("points", points.finish(), random_rays(1), 1000);
}

TEST(WideBvh, InvalidRaysHitNothing) {
    const double inf = std::numeric_limits<double>::infinity();
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const PrimitiveTable table = random_mixture(100, 1, 2, 21);
    for (const auto& entry : accelerator_table()) {
        const auto aggregate = make_aggregate(entry.name, table);
        for (const Ray& ray :
             {Ray{{nan, 0, 0}, {1, 0, 0}}, Ray{{0, 0, 0}, {1, nan, 0}}, Ray{{inf, 0, 0}, {1, 0, 0}},
              Ray{{0, 0, 0}, {-inf, 0, 0}}, Ray{{0, 0, 0}, {0, -0.0, 0}},
              Ray{{0, 0, 0}, {1, 0, 0}, nan, 1}, Ray{{0, 0, 0}, {1, 0, 0}, 0, nan},
              Ray{{0, 0, 0}, {1, 0, 0}, 2, 1}}) {
            Hit hit;
            std::vector<Hit> hits;
            EXPECT_FALSE(aggregate->closest(ray, hit, nullptr)) << entry.name << show(ray);
            EXPECT_FALSE(aggregate->occluded(ray, nullptr)) << entry.name << show(ray);
            EXPECT_FALSE(aggregate->shadowed(ray, hits, nullptr)) << entry.name << show(ray);
            aggregate->all_hits(ray, hits, nullptr);
            EXPECT_TRUE(hits.empty()) << entry.name << show(ray);
        }
    }
}

TEST(WideBvh, NestedAggregatesGiveTheHitsOfNestedLists) {
    const auto nest = [](const char* name) {
        const std::shared_ptr<const Aggregate> inner =
            make_aggregate(name, random_mixture(60, 1, 0.3, 22));
        const std::shared_ptr<const Aggregate> nothing =
            make_aggregate(name, TableBuilder{}.finish());
        RandomEngine random(23);
        TableBuilder builder;
        for (int i = 0; i < 30; ++i) {
            Placement placement;
            placement.outer_from_inner.linear = {{0.2, 0, 0}, {0, 0.1, 0.1}, {0, -0.1, 0.1}};
            placement.outer_from_inner.translation = uniform_point(random, 1);
            placement.inner_from_outer = inverse(placement.outer_from_inner);
            builder.table.instances.push_back(
                {.aggregate = i % 5 == 0 ? nothing : inner, .placement = placement});
        }
        builder.add_sphere({0, 0, 0}, 0.4);
        return make_aggregate(name, builder.finish());
    };
    const auto list = nest("list");
    const auto tree = nest("wide_bvh");
    RandomEngine random(24);
    const MakeRay rays = random_rays(1);
    for (int i = 0; i < 1000; ++i) {
        const Ray ray = rays(random);
        ASSERT_EQ(difference(ask(*list, ray), ask(*tree, ray)), "")
            << "ray " << i << ": " << show(ray);
    }
}

TEST(WideBvh, CountsWhatItDid) {
    const auto tree = make_aggregate("wide_bvh", random_triangles(1000, 1, 0.1, 25));
    RandomEngine random(26);
    const MakeRay rays = random_rays(1);
    TraversalStats stats;
    std::uint64_t found = 0;
    for (int i = 0; i < 1000; ++i) {
        Hit hit;
        found += tree->closest(rays(random), hit, &stats);
    }
    EXPECT_GT(found, 0u);
    EXPECT_GE(stats.primitive_hits, found);
    EXPECT_GE(stats.primitive_tests, stats.primitive_hits);
    EXPECT_LT(stats.primitive_tests, 1000u * 100u) << "of a million by brute force";
    EXPECT_GE(stats.box_tests, 2 * stats.node_visits);
    EXPECT_LE(stats.box_tests, 8 * stats.node_visits);
}

bool same_layout(const WideBvhLayout& a, const WideBvhLayout& b) {
    const auto equal = [](const auto& x, const auto& y) {
        return x.size() == y.size() &&
               (x.empty() || std::memcmp(x.data(), y.data(), x.size() * sizeof(x[0])) == 0);
    };
    if (a.tree.nodes.size() != b.tree.nodes.size() || a.tree.root != b.tree.root) return false;
    for (std::size_t i = 0; i < a.tree.nodes.size(); ++i) {
        const WideNode& m = a.tree.nodes[i];
        const WideNode& n = b.tree.nodes[i];
        if (std::memcmp(m.planes, n.planes, sizeof(m.planes)) != 0) return false;
        if (std::memcmp(m.child, n.child, sizeof(m.child)) != 0) return false;
    }
    return equal(a.triangles, b.triangles) && equal(a.others, b.others);
}

/// Beyond BoundedPrimitives::kReach they lie outside of the tree.
TEST(WideBvh, TrianglesWithoutBoundsAreHitInEveryDirection) {
    auto mesh = std::make_shared<TriangleMesh>();
    constexpr double kFar = 3e150;
    mesh->positions = {
        {0, kFar, -kFar}, {0, -kFar, -kFar}, {0, 0, kFar}, {kFar, 0, -kFar}, {-kFar, 0, -kFar}};
    mesh->triangles = {{0, 1, 2}, {3, 4, 2}};
    PrimitiveTable table;
    table.meshes.push_back({mesh, MaterialId{0}, 0, false});
    table.material_opacity = {Opacity::Opaque};
    table.finish();
    compare("far triangles", table, [](RandomEngine& random) {
        std::uniform_real_distribution<double> place(-9, 9);
        const auto point = [&] { return Vec3{place(random), place(random), place(random)}; };
        return Ray{point(), normalize(point()), 0, std::numeric_limits<double>::infinity()};
    });
}

TEST(WideBvh, TheTreeDoesNotDependOnTheNumberOfThreads) {
    const PrimitiveTable table = random_triangles(100000, 1, 0.01, 27);
    std::unique_ptr<WideBvhAggregate> one, two;
    ThreadLimit(1).run([&] { one = std::make_unique<WideBvhAggregate>(table); });
    ThreadLimit(2).run([&] { two = std::make_unique<WideBvhAggregate>(table); });
    EXPECT_TRUE(same_layout(one->layout(), two->layout()));
    EXPECT_GT(one->layout().tree.nodes.size(), 1000u);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
