/// Lines over closed solids: exact shapes, constructive solids, instances of instances, and all of
/// them with meshes. Every line crosses every solid an even number of times, and its first hit, by
/// single calls, the stream, packets and lanes, is that of `list`: for leaves with vertices and
/// with indices, nodes of 4, 8 and 16 children, on every instruction set of the machine.
///
/// ALHAZEN_LEAK_LINES: number of lines, default 10^9. ALHAZEN_LEAK_FIRST_SCENE: where a part of a
/// longer run begins, default 0; a scene has 196 608 lines.

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "alhazen/parallel/parallel.h"
#include "alhazen/simd/targets.h"
#include "alhazen/verification/verify_rays.h"
#include "support/random_shapes.h"
#include "support/random_solids.h"
#include "support/scene_maker.h"
#include "support/sphere_mesh.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::Random;
using testing::SceneMaker;

constexpr std::size_t kBlockLines = 1024;
constexpr std::size_t kBlocksPerScene = 192;
constexpr std::array<std::uint32_t, 3> kWidths{8, 4, 16};

/// Adds a random shape of the type; false if it is open.
template <class S>
bool add_closed_shape(SceneMaker& maker, Random& random, ObjectIndex owner,
                      const Affine& placement) {
    if constexpr (S::kClosed) {
        S shape = testing::RandomShape<S>::make(testing::ShapeSource{random});
        if (!shape.closed()) return false;
        shape.prepare();
        if (!shape.box().bounded()) return false;
        maker.add(std::move(shape), MaterialId{0}, placement, owner);
        return true;
    }
    return false;
}
using Shapes = AnalyticShapes::Variant;
using AddShape = bool (*)(SceneMaker&, Random&, ObjectIndex, const Affine&);
template <std::size_t... I>
constexpr std::array<AddShape, sizeof...(I)> adders(std::index_sequence<I...>) {
    return {&add_closed_shape<std::variant_alternative_t<I, Shapes>>...};
}
constexpr auto kAdders = adders(std::make_index_sequence<std::variant_size_v<Shapes>>());

void add_closed_shapes(SceneMaker& maker, Random& random, int count, ObjectIndex owner,
                       const Affine& placement = {}) {
    while (count > 0) {
        const auto type = static_cast<std::size_t>(random.below(static_cast<int>(kAdders.size())));
        if (kAdders[type](maker, random, owner, placement)) --count;
    }
}

Affine random_placement(Random& random, double reach) {
    return Affine::translate(random.in_cube(reach)) *
           Affine::rotate(random.unit_vector(), random.uniform(0, 6)) *
           Affine::scale({random.uniform(0.5, 2), random.uniform(0.5, 2), random.uniform(0.5, 2)});
}
void add_constructive(SceneMaker& maker, std::uint64_t seed, int count, ObjectIndex owner) {
    RandomStream stream(seed);
    Random random(seed);
    testing::RandomSolids solids(maker, stream, seed % 3 == 0);
    for (int i = 0; i < count; ++i) {
        maker.add(solids.tree(2 + random.below(10)), MaterialId{0}, random_placement(random, 3),
                  owner);
    }
}
void add_meshes(SceneMaker& maker, Random& random, int count, ObjectIndex owner) {
    testing::SphereMesh sphere(1);
    TriangleMesh ball;
    ball.positions = std::move(sphere.positions);
    ball.triangles = std::move(sphere.triangles);
    const MeshIndex meshes[] = {maker.mesh(testing::tetrahedron()), maker.mesh(std::move(ball))};
    for (int i = 0; i < count; ++i) {
        maker.add(meshes[random.below(2)], MaterialId{0}, random_placement(random, 3), owner);
    }
}
/// Objects of shapes, solids and meshes, placed in objects that are placed.
void add_instances(SceneMaker& maker, Random& random, std::uint64_t seed) {
    const ObjectIndex inner = maker.object("inner"), middle = maker.object("middle");
    // As near to each other as the rest.
    add_closed_shapes(maker, random, 3, inner, Affine::scale({0.1, 0.1, 0.1}));
    add_constructive(maker, seed, 1, inner);
    add_meshes(maker, random, 2, inner);
    for (int i = 0; i < 3; ++i)
        maker.add(inner, MaterialId{0}, random_placement(random, 4), middle);
    for (int i = 0; i < 3; ++i) maker.add(middle, MaterialId{0}, random_placement(random, 8));
}

struct Kind {
    const char* name;
    void (*add)(SceneMaker&, Random&, std::uint64_t seed);
};
constexpr Kind kKinds[] = {
    {"few shapes", [](SceneMaker& m, Random& r,
                      std::uint64_t) { add_closed_shapes(m, r, 1 + r.below(4), ObjectIndex{0}); }},
    {"shapes",
     [](SceneMaker& m, Random& r, std::uint64_t) { add_closed_shapes(m, r, 12, ObjectIndex{0}); }},
    {"constructive solids",
     [](SceneMaker& m, Random&, std::uint64_t seed) {
         add_constructive(m, seed, 4, ObjectIndex{0});
     }},
    {"instances", [](SceneMaker& m, Random& r, std::uint64_t seed) { add_instances(m, r, seed); }},
    {"all",
     [](SceneMaker& m, Random& r, std::uint64_t seed) {
         add_closed_shapes(m, r, 6, ObjectIndex{0});
         add_constructive(m, seed, 2, ObjectIndex{0});
         add_meshes(m, r, 3, ObjectIndex{0});
     }},
};

bool same(const Hit& a, const Hit& b) {
    if (!a.found() || !b.found()) return a.found() == b.found();
    return a.t == b.t && a.u == b.u && a.v == b.v && a.part == b.part &&
           a.primitive == b.primitive && a.path == b.path;
}

/// Counts per kind of scene.
struct Counts {
    std::atomic<std::uint64_t> lines{0}, hits{0}, odd{0}, differing{0};
};

class Leaks {
  public:
    void trace_scene(std::uint64_t seed, const std::string& target) {
        const std::size_t kind = seed % std::size(kKinds);
        // Every combination of target, width and leaves comes in turn, for every kind.
        const std::uint64_t round = seed / std::size(kKinds);
        const BuildOptions build{.leaves = round / 3 % 2 == 0 ? Leaves::Vertices : Leaves::Indices,
                                 .width = kWidths[round % 3]};
        SceneMaker maker;
        Random random(static_cast<std::uint32_t>(seed));
        kKinds[kind].add(maker, random, seed);
        const Scene brute = maker.compile("list");
        const SimdTargetOverride chosen(target);
        const Scene tested =
            compile(maker.description(), {.accelerator = "wide_bvh", .build = build});
        what_ = std::string(kKinds[kind].name) + ", scene " + std::to_string(seed) + ", " + target +
                ", width " + std::to_string(build.width) +
                (build.leaves == Leaves::Indices ? ", indices" : "");
        parallel_for(kBlocksPerScene, 4, [&](std::size_t begin, std::size_t end) {
            for (std::size_t b = begin; b < end; ++b) {
                trace_block(*tested.aggregate, *brute.aggregate, mix64(seed * kBlocksPerScene + b),
                            counts_[kind]);
            }
        });
    }

    std::array<Counts, std::size(kKinds)> counts_;

  private:
    void trace_block(const Aggregate& tested, const Aggregate& brute, std::uint64_t seed,
                     Counts& counts) {
        // Every other block around one primitive, because most lines between small objects miss.
        const PrimitiveTable& table = tested.primitives();
        const Box3 box = seed % 2 == 0 ? tested.box() : table.box(seed / 2 % table.size());
        VerifyRays source(box, nullptr, table, seed);
        std::vector<VerifyRays::Sample> samples;
        for (int tile = 0; tile < 4; ++tile) source.append_tile(samples);
        while (samples.size() < kBlockLines) samples.push_back(source.next());
        std::vector<Ray> rays;
        for (const VerifyRays::Sample& sample : samples) rays.push_back(sample.ray);

        std::vector<Hit> expected(rays.size()), hits(rays.size()), crossings;
        const double infinity = std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < rays.size(); ++i) {
            counts.hits += brute.closest(rays[i], expected[i], nullptr);
            (void)tested.closest(rays[i], hits[i], nullptr);
            Ray line = rays[i];
            line.t_min = -infinity;
            line.t_max = infinity;
            crossings.clear();
            tested.all_hits(line, crossings, nullptr);
            if (crossings.size() % 2 != 0) report(counts.odd, "odd", line, samples[i].kind);
        }
        compare(rays, samples, expected, hits, "single", counts);
        for (const Coherence coherence : {Coherence::Any, Coherence::Coherent}) {
            hits.assign(rays.size(), Hit{});
            tested.closest_batch(rays, hits, nullptr, coherence);
            compare(rays, samples, expected, hits,
                    coherence == Coherence::Any ? "stream" : "coherent", counts);
        }
        counts.lines += rays.size();
    }
    void compare(const std::vector<Ray>& rays, const std::vector<VerifyRays::Sample>& samples,
                 const std::vector<Hit>& expected, const std::vector<Hit>& hits, const char* road,
                 Counts& counts) {
        for (std::size_t i = 0; i < rays.size(); ++i) {
            if (!same(expected[i], hits[i])) {
                report(counts.differing, road, rays[i], samples[i].kind);
            }
        }
    }
    void report(std::atomic<std::uint64_t>& count, const char* how, const Ray& ray,
                const char* kind) {
        constexpr std::uint64_t kMostReported = 5;
        if (++count > kMostReported) return;
        const std::lock_guard lock(mutex_);
        ADD_FAILURE() << what_ << ": " << how << ", " << kind << " ray "
                      << ::testing::PrintToString(std::array<double, 6>{
                             ray.origin.x, ray.origin.y, ray.origin.z, ray.direction.x,
                             ray.direction.y, ray.direction.z});
    }

    std::string what_;
    std::mutex mutex_;
};

TEST(SolidLeaks, NoLineLeavesAClosedSolid) {
    const char* wanted = std::getenv("ALHAZEN_LEAK_LINES");
    const double lines = wanted != nullptr ? std::atof(wanted) : 1e9;
    ASSERT_GT(lines, 0);
    const std::vector<std::string> targets = simd_targets();
    Leaks leaks;
    const char* first = std::getenv("ALHAZEN_LEAK_FIRST_SCENE");
    const std::uint64_t first_scene = first != nullptr ? std::strtoull(first, nullptr, 10) : 0;
    std::uint64_t seed = first_scene;
    const auto begin = std::chrono::steady_clock::now();
    for (double done = 0; done < lines;
         done += static_cast<double>(kBlockLines * kBlocksPerScene)) {
        // The best instruction set every other time.
        const std::uint64_t round = seed / (6 * std::size(kKinds));
        const std::string& target =
            round % 2 == 0 ? targets.front() : targets[round / 2 % targets.size()];
        leaks.trace_scene(seed++, target);
    }
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
    std::printf("%-20s %12s %12s %6s %10s\n", "scenes", "lines", "hits", "odd", "differing");
    for (std::size_t k = 0; k < std::size(kKinds); ++k) {
        const Counts& c = leaks.counts_[k];
        std::printf("%-20s %12llu %12llu %6llu %10llu\n", kKinds[k].name,
                    static_cast<unsigned long long>(c.lines),
                    static_cast<unsigned long long>(c.hits), static_cast<unsigned long long>(c.odd),
                    static_cast<unsigned long long>(c.differing));
        EXPECT_EQ(c.odd, 0u) << kKinds[k].name;
        EXPECT_EQ(c.differing, 0u) << kKinds[k].name;
        if (lines >= 1e6) {
            EXPECT_GT(c.hits, c.lines / 10) << kKinds[k].name;
        }
    }
    std::printf("scenes %llu to %llu, %.0f s\n", static_cast<unsigned long long>(first_scene),
                static_cast<unsigned long long>(seed), took.count());
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
