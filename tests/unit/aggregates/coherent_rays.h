#pragma once
/// Coherent rays, and the comparison of their batches with the hits of the list.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <memory>

#include "alhazen/aggregates/accelerator_table.h"
#include "alhazen/aggregates/wide_bvh/wide_bvh_aggregate.h"
#include "alhazen/simd/targets.h"
#include "unit/aggregates/compare_aggregates.h"

namespace alhazen::testing {

using Rays = std::vector<Ray>;

/// The rays rounded to float, in columns.
class FloatColumns {
  public:
    /// `all`: numbers that all rays have in common have a column too.
    FloatColumns(const Rays& rays, bool all) {
        for (const Ray& ray : rays) {
            for (int k = 0; k < 3; ++k) {
                numbers_[k].push_back(static_cast<float>(ray.origin[k]));
                numbers_[3 + k].push_back(static_cast<float>(ray.direction[k]));
            }
            numbers_[6].push_back(static_cast<float>(ray.t_min));
            numbers_[7].push_back(static_cast<float>(ray.t_max));
        }
        const auto in_common = [&](std::size_t k) {
            // By their bits: zeros have signs.
            const auto bits = [](float x) { return std::bit_cast<std::uint32_t>(x); };
            return !all && !numbers_[k].empty() && std::ranges::all_of(numbers_[k], [&](float x) {
                return bits(x) == bits(numbers_[k].front());
            });
        };
        one_point_ = in_common(0) && in_common(1) && in_common(2);
        for (std::size_t k = 0; k < 3; ++k) {
            rays_.directions[k] = numbers_[3 + k];
            if (one_point_) rays_.origin[k] = numbers_[k].front();
            if (!one_point_) rays_.origins[k] = numbers_[k];
        }
        for (std::size_t k = 0; k < 2; ++k) {
            one_range_[k] = in_common(6 + k);
            if (one_range_[k]) rays_.range[k] = numbers_[6 + k].front();
        }
        if (!one_range_[0]) rays_.t_min = numbers_[6];
        if (!one_range_[1]) rays_.t_max = numbers_[7];
    }
    [[nodiscard]] const RayColumns& rays() const { return rays_; }
    [[nodiscard]] bool shortened() const { return one_point_ || one_range_[0] || one_range_[1]; }

  private:
    std::array<std::vector<float>, 8> numbers_;
    RayColumns rays_;
    bool one_point_, one_range_[2];
};

/// Compares rays in columns with the same rays one by one.
inline void compare_columns(const Aggregate& tested, const Rays& rays, const std::string& name,
                            Coherence coherence = Coherence::Coherent) {
    for (const bool all : {true, false}) {
        const FloatColumns columns(rays, all);
        if (!all && !columns.shortened()) continue;
        const std::size_t count = rays.size();
        std::vector<double> t(count, -1), u(count, -2), v(count, -3), only_t(count, -4);
        std::vector<PrimitiveId> ids(count, PrimitiveId{7});
        const auto occluded = std::make_unique<bool[]>(count);
        for (std::size_t i = 0; i < count; ++i) occluded[i] = i % 3 == 0;
        tested.closest_columns(columns.rays(), {t, u, v, ids}, nullptr, coherence);
        tested.closest_columns(columns.rays(), {only_t}, nullptr, coherence);
        tested.occluded_columns(columns.rays(), {occluded.get(), count}, nullptr, coherence);
        for (std::size_t i = 0; i < count; ++i) {
            const Ray ray = columns.rays().ray(i);
            Hit expected;
            const bool found = tested.closest(ray, expected, nullptr);
            const auto same_bits = [](double a, double b) {
                return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
            };
            ASSERT_TRUE(same_bits(t[i], expected.t) && same_bits(u[i], expected.u) &&
                        same_bits(v[i], expected.v) && ids[i] == expected.top())
                << name << ", columns, ray " << i << ": " << show(ray) << ": " << show(expected)
                << " became t " << t[i];
            ASSERT_TRUE(same_bits(only_t[i], t[i])) << name << ", columns of t, ray " << i;
            ASSERT_EQ(occluded[i], found) << name << ", columns, ray " << i << ": " << show(ray);
        }
    }
}

/// Compares packets directly, even if the aggregate would not choose them. `waits`: as in a large
/// tree.
inline void compare_packets(const WideBvhAggregate& tested, const Rays& rays,
                            const std::vector<Hit>& expected, const std::string& name, bool waits) {
    WideBvhScene scene(tested.primitives(), tested.layout());
    scene.waits = waits;
    std::vector<Hit> hits(rays.size());
    wide_bvh_kernels(8).plain.closest_coherent(scene, rays, hits, false, nullptr);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        ASSERT_TRUE(same(hits[i], expected[i])) << name << ", packets, ray " << i;
    }
    Hit wrong;
    wrong.t = -1;
    wrong.u = wrong.v = -2;
    wrong.part = 3;
    wrong.primitive = PrimitiveId{4};
    wrong.path.push_back(PrimitiveId{5});
    hits.assign(rays.size(), wrong);
    wide_bvh_kernels(8).plain.closest_coherent(scene, rays, hits, true, nullptr);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        ASSERT_TRUE(same(hits[i], expected[i])) << name << ", packets, hits unset, ray " << i;
    }
    const auto occluded = std::make_unique<bool[]>(rays.size());
    // Rays that are occluded already stay so.
    for (std::size_t i = 0; i < rays.size(); ++i) occluded[i] = i % 16 == 5;
    wide_bvh_kernels(8).plain.occluded_coherent(scene, rays, {occluded.get(), rays.size()},
                                                nullptr);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        ASSERT_EQ(occluded[i], i % 16 == 5 || expected[i].found())
            << name << ", packets for any hit, ray " << i;
    }
}

inline void compare_with(const Aggregate& list, const Aggregate& tested, const Rays& rays,
                         const std::string& name) {
    std::vector<Hit> hits(rays.size());
    tested.closest_batch(rays, hits, nullptr, Coherence::Coherent);
    const auto occluded = std::make_unique<bool[]>(rays.size());
    tested.occluded_batch(rays, {occluded.get(), rays.size()}, nullptr, Coherence::Coherent);
    TraversalStats stats;
    std::vector<Hit> counted(rays.size());
    tested.closest_batch(rays, counted, &stats, Coherence::Coherent);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        Hit expected;
        const bool found = list.closest(rays[i], expected, nullptr);
        ASSERT_TRUE(same(hits[i], expected))
            << name << ", ray " << i << ": " << show(rays[i]) << ": " << show(expected)
            << " became " << show(hits[i]);
        ASSERT_EQ(occluded[i], found) << name << ", ray " << i << ": " << show(rays[i]);
        ASSERT_TRUE(same(counted[i], hits[i])) << name << ", ray " << i;
    }
    compare_columns(tested, rays, name);
    const auto* tree = dynamic_cast<const WideBvhAggregate*>(&tested);
    // Unbounded primitives are not in the tree.
    if (tree != nullptr && std::isfinite(tree->box().size().x) && !tree->layout().tree.empty) {
        compare_packets(*tree, rays, hits, name, false);
        compare_packets(*tree, rays, hits, name + ", in turn", true);
    }
}

/// Compares with the list on every instruction set.
inline void compare(const std::string& name, const PrimitiveTable& table, const Rays& rays,
                    bool some_hit = true) {
    const auto list = make_aggregate("list", table);
    std::size_t found = 0;
    for (const Ray& ray : rays) {
        Hit hit;
        found += list->closest(ray, hit, nullptr);
    }
    // Guards against comparing only misses.
    EXPECT_TRUE(!some_hit || found > 0) << name;
    for (const std::string& target : simd_targets()) {
        const SimdTargetOverride use(target);
        compare_with(*list, *make_aggregate("wide_bvh", table), rays, name + " on " + target);
    }
}

/// Eye rays through side x side points of a square, `width` wide at distance 1, along `look`.
inline Rays eye_rays(const Vec3& eye, const Vec3& look, double width, int side) {
    const Vec3 u = perpendicular(normalize(look));
    const Vec3 v = normalize(cross(look, u));
    Rays rays;
    for (int y = 0; y < side; ++y) {
        for (int x = 0; x < side; ++x) {
            const double a = width * ((x + 0.5) / side - 0.5), b = width * ((y + 0.5) / side - 0.5);
            rays.push_back(
                {eye, normalize(look) + a * u + b * v, 0, std::numeric_limits<double>::infinity()});
        }
    }
    return rays;
}

/// Shadow rays from points of a small square to a light.
inline Rays shadow_rays(const Vec3& middle, double width, const Vec3& light, int side) {
    Rays rays = eye_rays(middle, {0.2, 0.3, 1}, width, side);
    for (Ray& ray : rays) {
        ray.origin = middle + (ray.direction - Vec3{0.2, 0.3, 1});
        ray.direction = light - ray.origin;
        ray.t_max = 1;
    }
    return rays;
}

}  // namespace alhazen::testing
