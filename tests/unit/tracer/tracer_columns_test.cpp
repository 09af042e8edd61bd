// Rays in columns of floats hit what the same rays in double hit.

#include <gtest/gtest.h>

#include <bit>
#include <memory>

#include "alhazen/base/error.h"
#include "unit/tracer/tracer_cases.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::mixed_scene;

/// Eye rays of tiles, then others; some of unusual lengths, invalid or short.
class SomeRays {
  public:
    SomeRays(std::size_t count, bool usual, std::uint64_t seed) {
        std::mt19937_64 random(seed);
        const auto number = [&](double reach) {
            return static_cast<float>(testing::uniform(random, reach));
        };
        for (std::size_t i = 0; i < count; ++i) {
            const bool eye = i < count / 2;
            const float scale = usual || i % 9 != 4 ? 1.0f : i % 2 == 0 ? 1e-20f : 1e20f;
            const float x = 0.02f * static_cast<float>(i % 8), y = 0.003f * static_cast<float>(i);
            const float direction[3] = {eye ? x - 0.2f : number(1), eye ? y - 0.3f : number(1), -1};
            for (std::size_t k = 0; k < 3; ++k) {
                directions_[k].push_back(scale * direction[k]);
                origins_[k].push_back(eye ? origin_[k] : number(9));
            }
            t_min_.push_back(i % 5 == 0 ? 1.0f : 0.0f);
            t_max_.push_back(i % 7 == 0 ? 4.0f : std::numeric_limits<float>::infinity());
            if (!usual && i % 50 == 0) directions_[1].back() = std::nanf("");
            if (!usual && i % 51 == 0) {
                for (auto& column : directions_) column.back() = 0;
            }
        }
    }
    [[nodiscard]] RayColumns own_origins() const {
        RayColumns rays{{directions_[0], directions_[1], directions_[2]},
                        {origins_[0], origins_[1], origins_[2]}};
        rays.t_min = t_min_;
        rays.t_max = t_max_;
        return rays;
    }
    [[nodiscard]] RayColumns from_one_point() const {
        RayColumns rays{{directions_[0], directions_[1], directions_[2]}};
        rays.origin = origin_;
        rays.range = {0.5f, 30.0f};
        return rays;
    }

  private:
    std::array<float, 3> origin_{0.25f, -0.5f, 11.0f};
    std::array<std::vector<float>, 3> directions_, origins_;
    std::vector<float> t_min_, t_max_;
};

std::vector<Tracer> tracers() {
    std::mt19937_64 random(12);
    TracerScene triangles, others;
    for (int mesh = 0; mesh < 3; ++mesh) {
        std::vector<Vec3> corners;
        std::vector<std::array<std::uint32_t, 3>> indices;
        for (std::uint32_t i = 0; i < 120; ++i) {
            const Vec3 center = testing::uniform_point(random, 6);
            for (int k = 0; k < 3; ++k) {
                corners.push_back(center + testing::uniform_point(random, 1));
            }
            indices.push_back({3 * i, 3 * i + 1, 3 * i + 2});
        }
        triangles.add_mesh(corners, indices);
    }
    for (int i = 0; i < 40; ++i) others.add_sphere(testing::uniform_point(random, 6), 0.5);
    TracerScene with_plane = triangles;
    with_plane.add(Plane{.point = {0, 0, -9}});
    std::vector<Tracer> tracers;
    for (const TracerScene& scene :
         {triangles, others, with_plane, mixed_scene(9), TracerScene{}}) {
        tracers.emplace_back(scene);
    }
    tracers.emplace_back(triangles, TracerOptions{.accelerator = "list"});
    return tracers;
}

bool same_bits(double a, double b) {
    return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

void compare(const Tracer& tracer, const RayColumns& rays, Coherence coherence) {
    const std::size_t count = rays.size();
    std::vector<double> t(count, -1), u(count, -1), v(count, -1);
    std::vector<GeometryId> geometry(count), outermost(count);
    std::vector<std::uint32_t> primitive(count);
    const auto occluded = std::make_unique<bool[]>(count);
    tracer.intersect(rays, {t, u, v, geometry, primitive, outermost}, kAllRays, coherence);
    tracer.occluded(rays, {occluded.get(), count}, kAllRays, coherence);
    for (std::size_t i = 0; i < count; ++i) {
        Hit hit;
        const bool found = tracer.intersect(rays.ray(i), hit);
        HitIds ids{kNoGeometry, kNoTriangle, kNoGeometry};
        if (found) ids = tracer.ids(hit);
        ASSERT_TRUE(same_bits(t[i], hit.t) && same_bits(u[i], hit.u) && same_bits(v[i], hit.v))
            << i << ": " << t[i] << " for " << hit.t;
        ASSERT_TRUE(geometry[i] == ids.geometry && primitive[i] == ids.primitive &&
                    outermost[i] == ids.outermost)
            << i;
        ASSERT_EQ(occluded[i], found) << i;
    }
}

TEST(TracerColumns, HitWhatTheSameRaysInDoubleHit) {
    for (const Tracer& tracer : tracers()) {
        for (const bool usual : {true, false}) {
            for (const std::size_t count : {1, 33, 2100}) {
                const SomeRays rays(count, usual, 3 + count);
                for (const Coherence coherence : {Coherence::Any, Coherence::Coherent}) {
                    compare(tracer, rays.own_origins(), coherence);
                    compare(tracer, rays.from_one_point(), coherence);
                }
            }
        }
    }
}

TEST(TracerColumns, EmptyColumnsAreNotWritten) {
    const Tracer tracer = tracers().front();
    const SomeRays some(100, true, 5);
    const RayColumns rays = some.from_one_point();
    std::vector<double> t(100), only_t(100);
    std::vector<std::uint32_t> primitive(100), only_primitive(100);
    tracer.intersect(rays, {.t = t, .primitive = primitive}, kAllRays, Coherence::Coherent);
    tracer.intersect(rays, {.t = only_t}, kAllRays, Coherence::Coherent);
    tracer.intersect(rays, {.primitive = only_primitive}, kAllRays, Coherence::Coherent);
    EXPECT_EQ(t, only_t);
    EXPECT_EQ(primitive, only_primitive);
    tracer.intersect(RayColumns{}, {});
    tracer.occluded(RayColumns{}, {});
}

TEST(TracerColumns, OfDifferentLengthsAreRefused) {
    const Tracer tracer = tracers().front();
    const SomeRays some(10, true, 5);
    std::vector<double> t(10), few(9);
    bool occluded[10];
    EXPECT_NO_THROW(tracer.intersect(some.own_origins(), {.t = t}));
    EXPECT_THROW(tracer.intersect(some.own_origins(), {.t = t, .v = few}), Error);
    EXPECT_THROW(tracer.occluded(some.own_origins(), std::span(occluded).first(9)), Error);
    for (int which = 0; which < 4; ++which) {
        RayColumns rays = some.own_origins();
        std::span<const float>* const columns[] = {&rays.directions[2], &rays.origins[1],
                                                   &rays.t_min, &rays.t_max};
        *columns[which] = columns[which]->first(9);
        EXPECT_THROW(tracer.intersect(rays, {.t = t}), Error) << which;
        EXPECT_THROW(tracer.occluded(rays, occluded), Error) << which;
    }
    RayColumns rays = some.own_origins();
    rays.origins[0] = {};
    EXPECT_THROW(tracer.occluded(rays, occluded), Error) << "origins without x";
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
