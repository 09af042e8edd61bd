// Points and normals in lanes equal those of single hits.

#include "alhazen/shapes/core/lane_surfaces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <string>
#include <vector>

#include "alhazen/shapes/core/plain_surface.h"
#include "alhazen/shapes/quadrics/round_surfaces.h"
#include "alhazen/simd/targets.h"
#include "support/any_ray.h"
#include "support/random_shapes.h"
#include "support/thorough.h"
#include "unit/shapes/algebraic/surface_in_cube.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::any_ray;
using testing::Random;
using testing::surface_in_cube;
using testing::to_text;

/// A hit on part 0 and its ray.
struct RayHit {
    Ray ray;
    ShapeHit hit;
};

template <class S>
RayHit random_hit(const S& shape, Random& random) {
    for (;;) {
        const Ray ray = any_ray(shape.box(), random);
        ShapeHits hits(16);
        append_hits(shape, ray, hits);
        for (const ShapeHit& hit : hits) {
            if (hit.part == 0 && random.coin()) return {ray, hit};
        }
    }
}

/// Expects the lanes of `found` to have the surfaces of the shapes, `shape_of(lane)`.
template <class ShapeOf>
void check_lanes(const LaneSurfaces& lanes, std::uint32_t found, const std::vector<RayHit>& hits,
                 ShapeOf&& shape_of) {
    EXPECT_EQ(std::uint64_t{found} >> hits.size(), 0u);
    for_each_lane(found, [&](std::size_t i) {
        const ShapeSurface expected =
            surface_of_shape(shape_of(i), hits[i].ray, hits[i].hit, false);
        const auto lane = [&](const auto& rows) {
            return Vec3{rows[0][i], rows[1][i], rows[2][i]};
        };
        EXPECT_EQ(lane(lanes.point), expected.point) << to_text(hits[i].ray);
        EXPECT_EQ(lane(lanes.normal), expected.normal) << to_text(hits[i].ray);
        EXPECT_EQ(expected.normal, expected.shading_normal);
    });
}

void set_lanes(const std::vector<RayHit>& hits, LaneSurfaces& lanes) {
    for (std::size_t i = 0; i < kSurfaceLanes; ++i) {
        const RayHit& h = hits[i < hits.size() ? i : 0];
        lanes.set(i, h.ray, h.hit);
    }
}

/// Calls f(random, shape number) for each instruction set.
template <class F>
void for_each_target(std::uint64_t seed, F&& f) {
    const int shapes = testing::cases(30, 300);
    for (const std::string& target : simd_targets()) {
        const SimdTargetOverride forced(target);
        Random random(seed);
        for (int i = 0; i < shapes && !::testing::Test::HasFailure(); ++i) {
            SCOPED_TRACE(target + ", seed " + std::to_string(seed) + ", shape " +
                         std::to_string(i));
            f(random, i);
        }
    }
}

/// Blocks of hits of one shape, most of them near each other. Returns the share of lanes found.
template <class S>
double check_shape(const S& shape, Random& random) {
    int wanted_count = 0, found_count = 0;
    for (int block = 0; block < 20 && !::testing::Test::HasFailure(); ++block) {
        std::vector<RayHit> hits{random_hit(shape, random)};
        const std::size_t size = 1 + random.below(16);
        while (hits.size() < size) hits.push_back(random_hit(shape, random));
        LaneSurfaces lanes;
        set_lanes(hits, lanes);
        const std::uint32_t wanted = (1u << size) - 1;
        const std::uint32_t found = lane_surfaces(shape, wanted, lanes);
        check_lanes(lanes, found, hits, [&](std::size_t) -> const S& { return shape; });
        wanted_count += static_cast<int>(size);
        found_count += std::popcount(found);
    }
    return double(found_count) / wanted_count;
}

/// The best share of lanes found, over the instruction sets.
template <class Make>
double best_share(std::uint64_t seed, Make&& make) {
    double sum = 0.0, best = 0.0;
    int shapes = 0;
    for_each_target(seed, [&](Random& random, int i) {
        if (i == 0) sum = shapes = 0;
        sum += check_shape(make(random, i), random);
        best = std::max(best, sum / ++shapes);
    });
    return best;
}

TEST(LaneSurfaces, OfToriAreThoseOfEachHitAlone) {
    EXPECT_GT(best_share(1,
                         [](Random& random, int i) {
                             return testing::random_shape<Torus>({random, i % 2 == 1});
                         }),
              0.95);
}

/// True if some instruction set has fused operations, which double-double needs.
bool some_target_fuses() {
    const std::vector<std::string> targets = simd_targets();
    return std::any_of(targets.begin(), targets.end(), [](const std::string& target) {
        return target.starts_with("AVX") || target.starts_with("NEON");
    });
}

TEST(LaneSurfaces, OfAlgebraicSurfacesAreThoseOfEachHitAlone) {
    const double share = best_share(2, [](Random& random, int i) {
        return testing::random_shape<Algebraic>({random, i % 2 == 1});
    });
    if (some_target_fuses()) {
        EXPECT_GT(share, 0.9);
    }
}

TEST(LaneSurfaces, NearDoublePointsAreThoseOfEachHitAlone) {
    // Planes that cross, a cone's apex, and a polynomial with more operations than lanes hold.
    const char* const kExpressions[] = {
        "x*y", "x^2 + y^2 - z^2", "(x - y)*(x + y)*z",
        "(x+y+z)^3*(x-y)^3*(x+2*y)^2*(y+3*z)^2*(x-7*z) - 0.01*(x+1)*(y+2)*(z+3)*(x+y)*(y+z)"};
    best_share(3, [&](Random& random, int i) {
        return surface_in_cube(kExpressions[i % 4], random.log_uniform(1e-3, 1e3), true);
    });
}

TEST(LaneSurfaces, OfBlobsAreThoseOfEachHitAlone) {
    EXPECT_GT(best_share(4,
                         [](Random& random, int i) {
                             Blob blob = testing::random_shape<Blob>({random, i % 2 == 1});
                             if (i % 3 == 0) return blob;
                             for (BlobComponent& c : blob.components) c.rod = false;
                             blob.prepare();
                             return blob;
                         }),
              0.5);
}

/// Eight shapes of one type, a hit on each.
template <class S, class Find>
void check_many(std::uint64_t seed, Find&& find) {
    for_each_target(seed, [&](Random& random, int i) {
        std::vector<S> shapes;
        std::vector<RayHit> hits;
        while (shapes.size() < kSurfaceLanes) {
            shapes.push_back(testing::random_shape<S>({random, i % 2 == 1}));
            hits.push_back(random_hit(shapes.back(), random));
        }
        LaneSurfaces lanes;
        set_lanes(hits, lanes);
        const std::uint32_t found = find(shapes, lanes);
        check_lanes(lanes, found, hits, [&](std::size_t k) -> const S& { return shapes[k]; });
        EXPECT_GE(std::popcount(found), 12);
    });
}

TEST(LaneSurfaces, OfSpheresAreThoseOfEachHitAlone) {
    check_many<Sphere>(5, [](const std::vector<Sphere>& shapes, LaneSurfaces& lanes) {
        SphereLanes spheres;
        for (std::size_t i = 0; i < kSurfaceLanes; ++i) spheres.set(i, shapes[i]);
        return sphere_surfaces(spheres, 0xffff, lanes);
    });
}

template <class S>
std::uint32_t sides(const std::vector<S>& shapes, LaneSurfaces& lanes) {
    FrustumLanes frusta;
    for (std::size_t i = 0; i < kSurfaceLanes; ++i) frusta.set(i, shapes[i].frustum);
    return side_surfaces(frusta, 0xffff, lanes);
}

TEST(LaneSurfaces, OfSidesOfCylindersAndConesAreThoseOfEachHitAlone) {
    check_many<Cylinder>(
        6, [](const auto& shapes, LaneSurfaces& lanes) { return sides<Cylinder>(shapes, lanes); });
    check_many<Cone>(
        7, [](const auto& shapes, LaneSurfaces& lanes) { return sides<Cone>(shapes, lanes); });
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
