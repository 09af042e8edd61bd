#pragma once
/// Checks of random solids: both evaluators find the same transitions, and these agree with the
/// classification of points.

#include <gtest/gtest.h>

#include "alhazen/csg/csg_aggregate.h"
#include "alhazen/csg/csg_evaluator.h"
#include "alhazen/primitives/surface.h"
#include "support/random_solids.h"

namespace alhazen::testing {

/// The evaluators of solids.
inline constexpr const char* kEvaluators[] = {"event_heap", "roth"};

/// The CSG object of which the scene is one instance; null: it is not.
inline const CsgAggregate* solid_of(const Scene& scene) {
    const auto& instances = scene.aggregate->primitives().instances;
    if (instances.size() != 1) return nullptr;
    return dynamic_cast<const CsgAggregate*>(instances.front().aggregate.get());
}

inline Scene compiled(SceneMaker& maker, const std::string& evaluator,
                      const std::string& accelerator = "list") {
    if (maker.description().materials.empty()) maker.material({});
    Diagnostics diagnostics;
    validate(maker.description(), diagnostics);
    for (const Diagnostic& d : diagnostics.all()) {
        EXPECT_NE(d.severity, Severity::Error) << to_string(d);
    }
    return compile(maker.description(), {.accelerator = accelerator, .csg = evaluator});
}

inline std::vector<Hit> all_hits(const Scene& scene, const Ray& ray) {
    std::vector<Hit> hits;
    scene.aggregate->all_hits(ray, hits, nullptr);
    return hits;
}

inline void expect_same_hits(const std::vector<Hit>& a, const std::vector<Hit>& b,
                             const std::string& at) {
    ASSERT_EQ(a.size(), b.size()) << at;
    for (std::size_t i = 0; i < a.size(); ++i) {
        EXPECT_EQ(a[i].t, b[i].t) << at << " hit " << i;
        EXPECT_EQ(a[i].primitive, b[i].primitive) << at << " hit " << i;
        EXPECT_EQ(a[i].part, b[i].part) << at << " hit " << i;
        EXPECT_TRUE(a[i].path == b[i].path) << at << " hit " << i;
    }
}

/// Between transitions every point is on the side given by their number.
inline void expect_true_spans(const SceneDescription& d, ObjectIndex object, const Ray& ray,
                              const std::vector<Hit>& hits, RandomStream& random,
                              const std::string& at) {
    for (int i = 0; i < 24; ++i) {
        const double t = random.uniform(-3, 6);
        std::size_t before = 0;
        bool close = false;
        for (const Hit& hit : hits) {
            before += hit.t < t;
            close |= std::abs(hit.t - t) < 1e-7;
        }
        const Side side = side_of(d, object, ray.at(t));
        if (close || side == Side::OnSurface) continue;
        ASSERT_EQ(before % 2 == 1, side == Side::Inside) << at << " t " << t;
    }
}

inline void expect_rays_limited_to_the_same_hits(const Scene& scene, const Ray& line,
                                                 const std::vector<Hit>& hits, RandomStream& random,
                                                 const std::string& at) {
    Ray ray = line;
    ray.t_min = random.uniform(-2, 2);
    ray.t_max = ray.t_min + random.uniform(0, 3);
    std::vector<Hit> expected;
    for (const Hit& hit : hits) {
        if (ray.covers(hit.t)) expected.push_back(hit);
    }
    expect_same_hits(all_hits(scene, ray), expected, at + " limited");
    Hit first;
    ASSERT_EQ(scene.aggregate->closest(ray, first, nullptr), !expected.empty()) << at;
    ASSERT_EQ(scene.aggregate->occluded(ray, nullptr), !expected.empty()) << at;
    if (!expected.empty()) expect_same_hits({first}, {expected.front()}, at + " closest");
}

/// Normals point out of the solid: against the ray at entries.
inline void expect_outward_normals(const Scene& scene, const Ray& ray, const std::vector<Hit>& hits,
                                   const std::string& at) {
    for (std::size_t i = 0; i < hits.size(); ++i) {
        const double cosine =
            dot(surface_at(*scene.aggregate, ray, hits[i]).normal, normalize(ray.direction));
        if (std::abs(cosine) < 1e-6) continue;
        EXPECT_EQ(cosine < 0.0, i % 2 == 0) << at << " hit " << i;
    }
}

inline void check_random_trees(std::uint64_t first_seed, int trees, int rays) {
    for (int tree = 0; tree < trees && !::testing::Test::HasFailure(); ++tree) {
        const std::uint64_t seed = first_seed + static_cast<std::uint64_t>(tree);
        RandomStream random(seed);
        SceneMaker maker;
        maker.material({});
        const bool lattice = tree % 2 == 1;
        RandomSolids solids(maker, random, lattice);
        const ObjectIndex object = solids.tree(2 + tree % 11);
        maker.add(object);
        const Scene heap = compiled(maker, "event_heap", tree % 3 == 0 ? "wide_bvh" : "list");
        const Scene roth = compiled(maker, "roth");
        for (int i = 0; i < rays; ++i) {
            const std::string at = "seed " + std::to_string(seed) + " ray " + std::to_string(i);
            Ray line = solids.ray();
            line.t_min = -std::numeric_limits<double>::infinity();
            const std::vector<Hit> hits = all_hits(heap, line);
            EXPECT_EQ(hits.size() % 2, 0u) << at;
            expect_same_hits(hits, all_hits(roth, line), at);
            expect_true_spans(maker.description(), object, line, hits, random, at);
            expect_rays_limited_to_the_same_hits(heap, line, hits, random, at);
            expect_outward_normals(heap, line, hits, at);
            if (::testing::Test::HasFailure()) return;
        }
    }
}

}  // namespace alhazen::testing
