// The first-crossing query equals the first of all crossings, bit for bit; so does the surface
// without texture coordinates.

#include "alhazen/shapes/core/first_hit.h"

#include <gtest/gtest.h>

#include <bit>
#include <sstream>

#include "alhazen/shapes/core/plain_surface.h"
#include "support/any_ray.h"
#include "support/random_shapes.h"
#include "unit/shapes/algebraic/surface_in_cube.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::Random;
using testing::surface_in_cube;
using testing::to_text;

bool same_bits(double a, double b) {
    return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}
bool same(const Vec3& a, const Vec3& b) {
    return same_bits(a.x, b.x) && same_bits(a.y, b.y) && same_bits(a.z, b.z);
}

/// Rays through the shape's box, from outside and inside, with ranges that begin or end anywhere.
template <class S>
Ray aimed_ray(const S& shape, Random& random) {
    const Box3 box = shape.box();
    Vec3 target;
    for (int k = 0; k < 3; ++k) target[k] = random.uniform(box.lo[k], box.hi[k]);
    const double distance[] = {0.0, 0.5, 3.0, 100.0};
    const Vec3 direction = random.log_uniform(0.1, 10) * random.unit_vector();
    const double away = distance[random.below(4)] * length(box.size()) / length(direction);
    Ray ray{target - away * direction, direction};
    if (random.below(3) == 0) ray.t_min = -std::numeric_limits<double>::infinity();
    if (random.below(4) == 0) ray.t_min = random.uniform(-0.1, 1.1) * away;
    if (random.below(4) == 0) ray.t_max = ray.t_min + random.uniform(0, 2) * (away + 0.1);
    return ray;
}

/// Checks one shape with many rays and returns the number of hits.
template <class S>
int check_first(const S& shape, Random& random, int rays) {
    int hit_count = 0;
    for (int i = 0; i < rays; ++i) {
        const Ray ray = aimed_ray(shape, random);
        ShapeHits all;
        append_hits(shape, ray, all);
        ShapeHit first;
        const bool found = find_first_hit(shape, ray, first);
        EXPECT_EQ(found, !all.empty()) << S::kName << " " << to_text(ray);
        if (!found || all.empty()) continue;
        ++hit_count;
        const ShapeHit& expected = all.front();
        EXPECT_TRUE(same_bits(first.t, expected.t) && same_bits(first.u, expected.u) &&
                    same_bits(first.v, expected.v) && first.part == expected.part)
            << S::kName << " " << to_text(ray) << " t " << first.t << " expected " << expected.t;
        const ShapeSurface whole = shape.surface(ray, first);
        const ShapeSurface plain = surface_of_shape(shape, ray, first, false);
        EXPECT_TRUE(same(whole.point, plain.point) && same(whole.normal, plain.normal) &&
                    same(whole.shading_normal, plain.shading_normal) &&
                    same(whole.error, plain.error))
            << S::kName << " " << to_text(ray);
        if (::testing::Test::HasFailure()) return hit_count;
    }
    return hit_count;
}

template <class S>
void check_random_shapes(std::uint64_t seed) {
    Random random(seed);
    int hit_count = 0;
    for (int i = 0; i < 100 && !::testing::Test::HasFailure(); ++i) {
        SCOPED_TRACE("seed " + std::to_string(seed) + ", shape " + std::to_string(i));
        hit_count += check_first(testing::random_shape<S>({random, i % 2 == 1}), random, 100);
    }
    EXPECT_GT(hit_count, 2000) << S::kName;
}

TEST(FirstHit, IsTheFirstOfAllCrossingsOfRandomShapes) {
    check_random_shapes<Torus>(1);
    check_random_shapes<Tgc>(2);
    check_random_shapes<Algebraic>(3);
    check_random_shapes<Sphere>(4);
    check_random_shapes<Blob>(5);
    check_random_shapes<Cylinder>(6);
}

TEST(FirstHit, IsTheFirstOfAllCrossingsOfSurfacesWithDoublePoints) {
    const char* barth =
        "4*(2.618033988749895*x^2 - y^2)*(2.618033988749895*y^2 - z^2)"
        "*(2.618033988749895*z^2 - x^2) - 4.23606797749979*(x^2 + y^2 + z^2 - 1)^2";
    const char* cayley = "x^2 + y^2 - x^2*z + y^2*z + z^2 - 1";
    Random random(7);
    for (const char* expression : {barth, cayley}) {
        for (const bool capped : {true, false}) {
            EXPECT_GT(check_first(surface_in_cube(expression, 1.5, capped), random, 4000), 1000);
        }
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
