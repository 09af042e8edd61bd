// First crossings of rays in lanes equal those of single rays, bit for bit.

#include "alhazen/shapes/core/first_hits.h"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <sstream>

#include "alhazen/shapes/core/first_hit.h"
#include "alhazen/simd/targets.h"
#include "support/any_ray.h"
#include "support/random_shapes.h"
#include "support/thorough.h"
#include "unit/shapes/algebraic/surface_in_cube.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::any_ray;
using testing::Random;
using testing::same_bits;
using testing::surface_in_cube;
using testing::to_text;

/// Checks the first `count` rays in lanes; returns how many of these hit.
template <class S, std::size_t N>
int check_block(const S& shape, const std::array<Ray, N>& rays, std::size_t count) {
    std::array<const Ray*, N> pointers;
    for (std::size_t i = 0; i < N; ++i) pointers[i] = &rays[i];
    std::array<ShapeHit, N> hits;
    const std::uint32_t found = first_hits(shape, std::span(pointers).first(count), hits.data());
    EXPECT_EQ(std::uint64_t{found} >> count, 0u);
    for (std::size_t i = 0; i < count; ++i) {
        ShapeHit alone;
        const bool hit = find_first_hit(shape, rays[i], alone);
        EXPECT_EQ(hit, (found >> i & 1) != 0) << S::kName << " " << to_text(rays[i]);
        if (!hit || (found >> i & 1) == 0) continue;
        EXPECT_TRUE(same_bits(alone, hits[i]))
            << S::kName << " " << to_text(rays[i]) << " t " << hits[i].t << " expected " << alone.t;
    }
    return std::popcount(found);
}

/// Blocks of rays of all kinds, and of coherent rays.
template <class S>
int check_shape(const S& shape, Random& random, int blocks) {
    int hit_count = 0;
    for (int block = 0; block < blocks && !::testing::Test::HasFailure(); ++block) {
        std::array<Ray, 8> rays;
        const Ray first = any_ray(shape.box(), random);
        const bool alike = random.coin();
        const double spread = alike ? random.log_uniform(1e-9, 0.3) : 0.0;
        for (Ray& ray : rays) {
            ray = alike ? first : any_ray(shape.box(), random);
            if (alike) {
                ray.direction += spread * length(ray.direction) * random.unit_vector();
            }
        }
        hit_count += check_block(shape, rays, 1 + static_cast<std::size_t>(block) % 8);
    }
    return hit_count;
}

template <class S>
void check_random_blocks(std::uint64_t seed, int least_hits = 3000) {
    const int shapes = testing::cases(30, 100);
    for (const std::string& target : simd_targets()) {
        const SimdTargetOverride forced(target);
        Random random(seed);
        int hit_count = 0;
        for (int i = 0; i < shapes && !::testing::Test::HasFailure(); ++i) {
            SCOPED_TRACE(target + ", seed " + std::to_string(seed) + ", shape " +
                         std::to_string(i));
            hit_count += check_shape(testing::random_shape<S>({random, i % 2 == 1}), random, 40);
        }
        EXPECT_GT(100 * hit_count, least_hits * shapes) << S::kName;
    }
}

TEST(FirstHits, OfToriAreThoseOfEachRayAlone) {
    check_random_blocks<Torus>(1);
}

TEST(FirstHits, OfSpheresAreThoseOfEachRayAlone) {
    check_random_blocks<Sphere>(6);
}

TEST(FirstHits, OfRaysThatGrazeASphereOrStartOnItAreThoseOfEachRayAlone) {
    const Sphere sphere{.center = {0.3, -2, 1e3}, .radius = 0.7};
    for (const std::string& target : simd_targets()) {
        const SimdTargetOverride forced(target);
        SCOPED_TRACE(target);
        Random random(7);
        int hit_count = 0;
        for (int block = 0; block < 2000 && !::testing::Test::HasFailure(); ++block) {
            std::array<Ray, 8> rays;
            for (Ray& ray : rays) {
                const Vec3 normal = random.unit_vector();
                const Vec3 along = normalize(cross(normal, random.unit_vector()));
                const double off = 1.0 + random.uniform(-4, 4) * 0x1p-53;
                const Vec3 point = sphere.center + (sphere.radius * off) * normal;
                const bool from_it = random.coin();
                const Vec3 direction = from_it ? random.unit_vector() : along;
                ray = {from_it ? point : point - random.log_uniform(1, 1e6) * direction, direction};
                if (random.below(50) == 0) ray.origin = sphere.center;
            }
            hit_count += check_block(sphere, rays, 8);
        }
        EXPECT_GT(hit_count, 4000);
    }
}

TEST(FirstHits, OfBlobsAreThoseOfEachRayAlone) {
    check_random_blocks<Blob>(5);
}

Blob blob_of(int count, double radius, Random& random) {
    Blob blob{.threshold = 0.6};
    for (int i = 0; i < count; ++i) {
        BlobComponent c{.base = random.in_cube(1), .radius = random.uniform(0.6, 1.6) * radius};
        c.strength = random.below(5) == 0 ? -0.7 : random.uniform(0.7, 1.5);
        c.rod = random.below(8) == 0;
        c.top = c.rod ? c.base + radius * random.in_cube(1) : c.base;
        blob.components.push_back(c);
    }
    blob.prepare();
    return blob;
}

TEST(FirstHits, OfBlobsOfManyComponentsAreThoseOfEachRayAlone) {
    for (const std::string& target : simd_targets()) {
        const SimdTargetOverride forced(target);
        SCOPED_TRACE(target);
        Random random(10);
        for (const int count : {1, 30, 64, 65, 300, 1000}) {
            SCOPED_TRACE(count);
            const Blob blob = blob_of(count, 1.5 / std::cbrt(count), random);
            EXPECT_GT(check_shape(blob, random, 400), 200);
        }
    }
}

TEST(FirstHits, OfRaysFromABlobAreThoseOfEachRayAlone) {
    for (const std::string& target : simd_targets()) {
        const SimdTargetOverride forced(target);
        SCOPED_TRACE(target);
        Random random(11);
        const Blob blob = blob_of(30, 0.5, random);
        int hit_count = 0;
        for (int block = 0; block < 2000 && !::testing::Test::HasFailure(); ++block) {
            const Ray first = any_ray(blob.box(), random);
            ShapeHit hit;
            if (!find_first_hit(blob, first, hit)) continue;
            const ShapeSurface surface = blob.surface(first, hit);
            const Vec3 along = random.unit_vector();
            const double spread = random.log_uniform(1e-9, 0.3);
            std::array<Ray, 8> rays;
            for (Ray& ray : rays) {
                const double off = random.sign() * random.log_uniform(1e-16, 1e-2);
                ray.origin = surface.point + off * surface.normal;
                ray.direction = along + spread * random.unit_vector();
            }
            hit_count += check_block(blob, rays, 1 + static_cast<std::size_t>(block) % 8);
        }
        EXPECT_GT(hit_count, 1000);
    }
}

TEST(FirstHits, OfAlgebraicSurfacesAreThoseOfEachRayAlone) {
    check_random_blocks<Algebraic>(2);
}

TEST(FirstHits, OfSurfacesOfEveryDegreeAreThoseOfEachRayAlone) {
    const char* barth =
        "4*(2.618033988749895*x^2 - y^2)*(2.618033988749895*y^2 - z^2)"
        "*(2.618033988749895*z^2 - x^2) - 4.23606797749979*(x^2 + y^2 + z^2 - 1)^2";
    const char* expressions[] = {"x + 2*y - z",
                                 "x^2 + y^2 - z^2 - 0.1",
                                 "x^2 + y^2 - x^2*z + y^2*z + z^2 - 1",
                                 "x^4 + y^4 + z^4 - 1.5*(x^2 + y^2 + z^2) + 0.3*x*y*z + 0.9",
                                 "x^5 - y^2 + z^3 - 0.2*x",
                                 barth,
                                 "x^8 + y^8 + z^8 - x^2*y^2*z^3 - 0.5",
                                 "(x^4 + y^4 + z^4 - 1)^3 - (x*y*z)^4"};
    for (const std::string& target : simd_targets()) {
        const SimdTargetOverride forced(target);
        SCOPED_TRACE(target);
        Random random(3);
        for (const char* expression : expressions) {
            for (const bool capped : {true, false}) {
                SCOPED_TRACE(expression);
                EXPECT_GT(check_shape(surface_in_cube(expression, 1.5, capped), random, 600), 300);
            }
        }
    }
}

TEST(FirstHits, OfPatchesAreThoseOfEachRayAlone) {
    check_random_blocks<BezierPatch>(7, 1000);
    check_random_blocks<PatchMesh>(8, 1000);
}

/// Incoherent rays, some coherent ones, and some with directions whose squares overflow or
/// underflow.
template <class S>
void check_many_rays(std::uint64_t seed, int least_hits) {
    constexpr std::size_t kMost = kMostRaysAtOnce<S>;
    static_assert(kMost > kMaxPacketRays);
    const int shapes = testing::cases(25, 100);
    for (const std::string& target : simd_targets()) {
        const SimdTargetOverride forced(target);
        Random random(seed);
        int hit_count = 0;
        for (int i = 0; i < shapes && !::testing::Test::HasFailure(); ++i) {
            SCOPED_TRACE(target + ", seed " + std::to_string(seed) + ", shape " +
                         std::to_string(i));
            const S shape = testing::random_shape<S>({random, i % 2 == 1});
            for (int block = 0; block < 10; ++block) {
                std::array<Ray, kMost> rays;
                for (std::size_t k = 0; k < kMost; ++k) {
                    rays[k] = any_ray(shape.box(), random);
                    if (block % 2 == 1 && k >= 8 && k < 16) {
                        rays[k] = rays[8];
                        rays[k].direction +=
                            (0.01 * length(rays[k].direction)) * random.unit_vector();
                    }
                    if (random.below(20) == 0) {
                        rays[k].direction =
                            random.log_uniform(1e-300, 1e300) * random.unit_vector();
                    }
                }
                const bool all = block < 5;
                hit_count += check_block(
                    shape, rays, all ? kMost : 1 + static_cast<std::size_t>(random.below(kMost)));
            }
        }
        EXPECT_GT(100 * hit_count, least_hits * shapes) << S::kName;
    }
}

TEST(FirstHits, OfManyRaysApartAtPatchesAreThoseOfEachRayAlone) {
    check_many_rays<BezierPatch>(12, 1000);
    check_many_rays<PatchMesh>(13, 1000);
}

TEST(FirstHits, OfRaysOfExtremeLengthsAreThoseOfEachRayAlone) {
    Torus torus;
    torus.prepare();
    const Algebraic quartic =
        surface_in_cube("x^4 + y^4 + z^4 - 1.5*(x^2 + y^2 + z^2) + 0.9", 1.5, true);
    const double lengths[] = {5e-324, 1e-310, 1e-300, 1e-160, 1e150, 1e200, 1e300, 1e308};
    for (const std::string& target : simd_targets()) {
        const SimdTargetOverride forced(target);
        SCOPED_TRACE(target);
        Random random(9);
        for (int block = 0; block < 400 && !::testing::Test::HasFailure(); ++block) {
            std::array<Ray, 8> rays;
            for (Ray& ray : rays) {
                ray = any_ray(torus.box(), random);
                ray.direction = lengths[random.below(8)] * random.unit_vector();
                ray.t_min = random.coin() ? 0 : -std::numeric_limits<double>::infinity();
                ray.t_max = std::numeric_limits<double>::infinity();
                if (ray.direction == Vec3{}) ray.direction.x = 5e-324;
            }
            check_block(torus, rays, 8);
            check_block(quartic, rays, 8);
            check_block(Sphere{{0, 0, 0}, 1}, rays, 8);
        }
    }
}

TEST(FirstHits, OfRaysThatGrazeATorusAreThoseOfEachRayAlone) {
    Torus torus;
    torus.prepare();
    Random random(4);
    int hit_count = 0;
    for (int block = 0; block < 2000 && !::testing::Test::HasFailure(); ++block) {
        std::array<Ray, 8> rays;
        for (Ray& ray : rays) {
            // Tangent to the tube, up to some roundings.
            const double turn = random.uniform(0, 2 * kPi), around = random.uniform(0, 2 * kPi);
            const Vec3 out{std::cos(turn), std::sin(turn), 0};
            const Vec3 normal = std::cos(around) * out + Vec3{0, 0, std::sin(around)};
            const Vec3 point = out + 0.25 * (1.0 + random.uniform(-1, 1) * 1e-15) * normal;
            const Vec3 along{-out.y, out.x, 0};
            const Vec3 across = cross(normal, along);
            const double mix = random.uniform(0, 2 * kPi);
            const Vec3 direction = std::cos(mix) * along + std::sin(mix) * across;
            ray = {point - 5.0 * direction, direction};
        }
        hit_count += check_block(torus, rays, 8);
    }
    EXPECT_GT(hit_count, 5000);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
