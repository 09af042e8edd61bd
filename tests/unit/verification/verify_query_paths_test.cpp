/// `verify` compares every traversal, and reports a wrong answer of any of them.

#include "alhazen/verification/verify_query_paths.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "support/random.h"
#include "support/random_patches.h"
#include "support/scene_maker.h"
#include "support/sphere_mesh.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::Random;
using testing::SceneMaker;

TriangleMesh round_mesh(int levels) {
    testing::SphereMesh sphere(levels);
    TriangleMesh mesh;
    mesh.positions = std::move(sphere.positions);
    mesh.triangles = std::move(sphere.triangles);
    return mesh;
}

void add_triangles(SceneMaker& maker) {
    maker.add(maker.mesh(round_mesh(3)));
    maker.add(maker.mesh(testing::tetrahedron()), MaterialId{0}, Affine::translate({1, 1, 0}));
}
/// Few shapes that lanes support: traced without a tree.
void add_few_spheres(SceneMaker& maker) {
    maker.add(Sphere{{0, 0, 0}, 1});
    maker.add(Sphere{{1, 0.5, 0.5}, 0.75});
    maker.add(Sphere{{-1, 0, 1}, 0.5}, MaterialId{0}, Affine::scale({1, 2, 1}));
}
void add_spheres(SceneMaker& maker) {
    Random random(3);
    for (int i = 0; i < 40; ++i) {
        maker.add(Sphere{random.in_cube(3), random.uniform(0.1, 0.6)});
        maker.add(Sphere{random.on_lattice(4, 0.5), 0.5});
    }
}
/// Solids evaluated by the truth table.
void add_solids(SceneMaker& maker) {
    Random random(4);
    for (int i = 0; i < 12; ++i) {
        const ObjectIndex solid = maker.object("drilled");
        maker.description().objects.back().combine = Combine::Difference;
        maker.add(Sphere{{0, 0, 0}, 1}, MaterialId{0}, {}, solid);
        maker.add(Sphere{random.in_cube(0.7), 0.6}, MaterialId{0}, {}, solid);
        maker.add(solid, MaterialId{0}, Affine::translate(random.in_cube(3)));
    }
}
void add_instances(SceneMaker& maker) {
    const ObjectIndex inner = maker.object("inner");
    maker.add(maker.mesh(round_mesh(2)), MaterialId{0}, {}, inner);
    maker.add(Cone{{0, 0, 1}, {0, 0, 2}, 0.5}, MaterialId{0}, {}, inner);
    Random random(5);
    for (int i = 0; i < 8; ++i) {
        maker.add(inner, MaterialId{0},
                  Affine::translate(random.in_cube(3)) *
                      Affine::rotate(random.unit_vector(), random.uniform(0, 6)));
    }
}
/// Closed meshes of patches, alone and turned, and a solid of one.
void add_patches(SceneMaker& maker) {
    maker.add(testing::patch_block({-1, -1, -1}, {1, 1, 1}));
    maker.add(testing::patch_block({0, 0, 0}, {1, 2, 1}), MaterialId{0},
              Affine::rotate({1, 2, 3}, 0.5));
    const ObjectIndex solid = maker.object("drilled");
    maker.description().objects.back().combine = Combine::Difference;
    maker.add(testing::patch_block({-2, 0, -1}, {1, 1, 1}), MaterialId{0}, {}, solid);
    maker.add(Sphere{{-2, 1, 1}, 0.6}, MaterialId{0}, {}, solid);
    maker.add(solid);
}
void add_everything(SceneMaker& maker) {
    add_triangles(maker);
    add_spheres(maker);
    add_solids(maker);
    add_instances(maker);
    maker.add(Plane{.point = {0, 0, -3}});
    maker.add(Torus{});
    auto& parts = maker.description().objects.front().parts;
    for (std::size_t i = 0; i < parts.size(); i += 3) {
        parts[i].visible_to = mask_of(RayKind::Eye) | mask_of(RayKind::Reflection);
    }
}

std::string first_of(const VerifyReport& report) {
    if (report.reported.empty()) return "";
    const Disagreement& d = report.reported.front();
    return d.query_path + " " + d.kind + " " + d.query + ": found " + d.found + ", expected " +
           d.expected;
}

TEST(VerifyRoads, EveryRoadAgreesOnScenesOfEveryKind) {
    const std::pair<const char*, std::function<void(SceneMaker&)>> cases[] = {
        {"triangles", add_triangles},
        {"few spheres", add_few_spheres},
        {"spheres", add_spheres},
        {"solids", add_solids},
        {"instances", add_instances},
        {"patches", add_patches},
        {"everything, some of it masked", add_everything}};
    for (const auto& [name, add] : cases) {
        SceneMaker maker;
        add(maker);
        (void)maker.compile();
        VerifyOptions options;
        options.rays = 2600;
        const VerifyReport report = verify(maker.description(), options);
        EXPECT_TRUE(report.holds()) << name << ": " << first_of(report);
        EXPECT_GT(report.hits, 600u) << name;
        EXPECT_EQ(report.rays, 2600u);
        EXPECT_EQ(report.query_paths[0].rays, 2600u);
        EXPECT_EQ(report.query_paths[1].rays, 2600u);
        // Two sets of 64 from each 512 rays; the last set is truncated.
        EXPECT_EQ(report.query_paths[2].rays, 5 * 128u + 40u);
    }
}

TEST(VerifyParity, AMeshByItselfIsCountedAsOneAmongOthers) {
    const auto counted = [](const std::function<void(SceneMaker&)>& add) {
        SceneMaker maker;
        add(maker);
        (void)maker.compile();
        VerifyOptions options;
        options.rays = 400;
        const VerifyReport report = verify(maker.description(), options);
        EXPECT_TRUE(report.holds()) << first_of(report);
        return std::array{report.closed_surfaces, report.open_meshes, report.parity_lines};
    };
    using Counts = std::array<std::uint64_t, 3>;
    const auto alone = [](SceneMaker& maker) { maker.add(maker.mesh(round_mesh(3))); };
    EXPECT_EQ(counted(alone), (Counts{1, 0, 400}));
    EXPECT_EQ(counted([&](SceneMaker& maker) {
                  maker.add(maker.mesh(round_mesh(3)), MaterialId{0}, Affine::translate({1, 0, 0}));
              }),
              (Counts{1, 0, 400}));
    EXPECT_EQ(counted([&](SceneMaker& maker) {
                  alone(maker);
                  maker.add(maker.mesh(testing::tetrahedron()));
              }),
              (Counts{2, 0, 400}));
    EXPECT_EQ(counted([&](SceneMaker& maker) {
                  alone(maker);
                  maker.description().objects.front().parts.front().visible_to =
                      mask_of(RayKind::Eye);
              }),
              (Counts{1, 0, 400}));
    EXPECT_EQ(counted([](SceneMaker& maker) {
                  TriangleMesh open = round_mesh(3);
                  open.triangles.pop_back();
                  maker.add(maker.mesh(std::move(open)));
              }),
              (Counts{0, 1, 0}));
}

/// Forwards queries to another aggregate.
class Delegating : public Aggregate {
  public:
    explicit Delegating(const Aggregate& honest) : honest_(honest) {}

    [[nodiscard]] const PrimitiveTable& primitives() const override { return honest_.primitives(); }
    [[nodiscard]] Box3 box() const override { return honest_.box(); }
    [[nodiscard]] std::size_t memory_bytes() const override { return honest_.memory_bytes(); }
    [[nodiscard]] bool closest(const Ray& ray, Hit& hit, RayQuery query) const override {
        return honest_.closest(ray, hit, query);
    }
    [[nodiscard]] bool occluded(const Ray& ray, RayQuery query) const override {
        return honest_.occluded(ray, query);
    }
    void all_hits(const Ray& ray, std::vector<Hit>& hits, RayQuery query) const override {
        honest_.all_hits(ray, hits, query);
    }
    [[nodiscard]] bool shadowed(const Ray& ray, std::vector<Hit>& crossings,
                                RayQuery query) const override {
        return honest_.shadowed(ray, crossings, query);
    }

  protected:
    const Aggregate& honest_;
};

/// Corrupts one hit, or one occlusion result, of each batch of a coherence.
class Spoiled final : public Delegating {
  public:
    /// Without `spoil_hit` corrupts occlusion.
    Spoiled(const Aggregate& honest, Coherence wrong, std::function<void(Hit&)> spoil_hit)
        : Delegating(honest), wrong_(wrong), spoil_hit_(std::move(spoil_hit)) {}

    void closest_batch(std::span<const Ray> rays, std::span<Hit> hits, RayQuery query,
                       Coherence coherence) const override {
        honest_.closest_batch(rays, hits, query, coherence);
        if (coherence != wrong_ || !spoil_hit_) return;
        const auto found = std::ranges::find_if(hits, &Hit::found);
        ASSERT_NE(found, hits.end());
        spoil_hit_(*found);
    }
    void occluded_batch(std::span<const Ray> rays, std::span<bool> occluded, RayQuery query,
                        Coherence coherence) const override {
        honest_.occluded_batch(rays, occluded, query, coherence);
        if (coherence == wrong_ && !spoil_hit_) occluded.back() = !occluded.back();
    }

  private:
    Coherence wrong_;
    std::function<void(Hit&)> spoil_hit_;
};

/// Leaves the results of batches unwritten.
class Silent final : public Delegating {
  public:
    using Delegating::Delegating;
    void closest_batch(std::span<const Ray>, std::span<Hit>, RayQuery, Coherence) const override {}
    void occluded_batch(std::span<const Ray>, std::span<bool>, RayQuery, Coherence) const override {
    }
};

VerifyReport compared(const Aggregate& tested, const Scene& brute, std::uint64_t rays) {
    VerifyOptions options;
    options.rays = rays;
    VerifyReport report;
    VerifyRays source(tested.box(), &brute.cameras.front().camera, tested.primitives(), 1);
    const BruteForce force(*brute.aggregate);
    QueryPathComparison(tested, force, options, report).run(source, false);
    return report;
}

TEST(VerifyRoads, AWrongAnswerOfABatchIsReportedWithItsRoad) {
    SceneMaker maker;
    maker.add(Sphere{{0, 0, 0}, 100});  // the camera is inside: each ray of the first tile hits
    const Scene brute = maker.compile("list");
    const Scene honest = maker.compile("wide_bvh");
    EXPECT_TRUE(compared(*honest.aggregate, brute, 300).holds());
    const std::function<void(Hit&)> spoils[] = {
        {},  // occlusion
        [](Hit& hit) { hit = Hit{}; },
        [](Hit& hit) { hit.t = std::nextafter(hit.t, 0.0); },
        [](Hit& hit) { hit.u += 1; },
        [](Hit& hit) { hit.v += 1; },
        [](Hit& hit) { ++hit.part; },
        [](Hit& hit) { hit.primitive = PrimitiveId{7}; },
        [](Hit& hit) { hit.path.push_back(PrimitiveId{0}); },
    };
    for (const Coherence wrong : {Coherence::Any, Coherence::Coherent}) {
        for (std::size_t i = 0; i < std::size(spoils); ++i) {
            const Spoiled spoiled(*honest.aggregate, wrong, spoils[i]);
            const VerifyReport report = compared(spoiled, brute, 64);
            EXPECT_FALSE(report.holds()) << i;
            const auto path = wrong == Coherence::Any ? QueryPath::Stream : QueryPath::Coherent;
            // A set is traced alone and with the others of its block.
            EXPECT_EQ(report.disagreements, wrong == Coherence::Any ? 1u : 2u) << i;
            EXPECT_EQ(report.query_paths[static_cast<std::size_t>(path)].disagreements,
                      report.disagreements);
            ASSERT_EQ(report.reported.size(), report.disagreements);
            EXPECT_EQ(report.reported.front().query_path,
                      kQueryPathNames[static_cast<std::size_t>(path)]);
            EXPECT_EQ(report.reported.front().query, i == 0 ? "occluded" : "closest");
            EXPECT_NE(report.reported.front().found, report.reported.front().expected);
        }
    }
}

TEST(VerifyRoads, ABatchThatWritesNothingIsReportedForEveryRay) {
    SceneMaker maker;
    maker.add(Sphere{});
    const Scene brute = maker.compile("list");
    const VerifyReport report = compared(Silent(*brute.aggregate), brute, 64);
    EXPECT_EQ(report.query_paths[0].disagreements, 0u);
    EXPECT_EQ(report.query_paths[1].disagreements, 2 * 64u);
    EXPECT_EQ(report.query_paths[2].disagreements, 4 * 64u);
}

TEST(VerifyRays, CoherentSetsAreTilesAndRaysTowardsAPoint) {
    SceneMaker maker;
    maker.add(Sphere{});
    const Scene scene = maker.compile();
    VerifyRays rays(scene.aggregate->box(), &scene.cameras.front().camera,
                    scene.aggregate->primitives(), 1);
    std::set<std::string> kinds;
    for (int set = 0; set < 40; ++set) {
        std::vector<VerifyRays::Sample> tile, shadows;
        rays.append_tile(tile);
        ASSERT_EQ(tile.size(), VerifyRays::kTileRays);
        std::vector<Vec3> origins;
        for (const VerifyRays::Sample& sample : tile) {
            ASSERT_TRUE(is_valid(sample.ray));
            ASSERT_EQ(sample.ray.origin, tile.front().ray.origin);
            // Neighbours are nearly parallel.
            ASSERT_GT(dot(normalize(sample.ray.direction), normalize(tile.front().ray.direction)),
                      -0.5);
            origins.push_back(sample.ray.at(2.0));
        }
        rays.append_shadow_rays(origins, shadows);
        ASSERT_EQ(shadows.size(), origins.size());
        const Ray& first = shadows.front().ray;
        for (std::size_t i = 0; i < shadows.size(); ++i) {
            const Ray& ray = shadows[i].ray;
            ASSERT_EQ(ray.origin, origins[i]);
            kinds.insert(shadows[i].kind);
            if (shadows[i].kind == std::string("parallel")) {
                ASSERT_EQ(ray.direction, first.direction);
            } else {
                ASSERT_LT(length(ray.at(ray.t_max) - first.at(first.t_max)), 1e-12);
            }
        }
    }
    EXPECT_EQ(kinds, (std::set<std::string>{"converging", "parallel"}));
}

TEST(VerifyRays, MostSetsOfCoherentRaysFitIntoPackets) {
    SceneMaker maker;
    add_triangles(maker);
    const Scene scene = maker.compile("wide_bvh");
    const Aggregate& aggregate = *scene.aggregate;
    VerifyRays rays(aggregate.box(), &scene.cameras.front().camera, aggregate.primitives(), 1);
    std::size_t packets = 0;
    constexpr std::size_t kSets = 60;
    for (std::size_t set = 0; set < kSets; ++set) {
        std::vector<VerifyRays::Sample> samples;
        if (set % 2 == 0) {
            rays.append_tile(samples);
        } else {
            std::vector<Vec3> origins;
            for (int i = 0; i < 64; ++i) origins.push_back({0.01 * (i % 8), 0.01 * (i / 8), 2});
            rays.append_shadow_rays(origins, samples);
        }
        std::vector<Ray> batch;
        for (const VerifyRays::Sample& sample : samples) batch.push_back(sample.ray);
        std::vector<Hit> hits(batch.size());
        TraversalStats any, coherent;
        aggregate.closest_batch(batch, hits, &any, Coherence::Any);
        aggregate.closest_batch(batch, hits, &coherent, Coherence::Coherent);
        // A packet visits a node once.
        packets += coherent.node_visits < any.node_visits / 4;
    }
    EXPECT_GT(packets, kSets / 2);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
