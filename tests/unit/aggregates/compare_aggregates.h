#pragma once
/// Tables and rays of most comparisons of aggregates.

#include <functional>
#include <limits>

#include "unit/aggregates/answers.h"
#include "unit/aggregates/random_tables.h"

namespace alhazen::testing {

using MakeRay = std::function<Ray(RandomEngine&)>;

inline MakeRay random_rays(double reach) {
    return [reach](RandomEngine& random) {
        Ray ray{uniform_point(random, 2 * reach), {}, 0, std::numeric_limits<double>::infinity()};
        ray.direction = uniform_point(random, reach) - ray.origin;
        if (random() % 4 == 0) ray.direction = normalize(ray.direction);
        if (random() % 8 == 0) ray.t_min = uniform(random, 0, 0.5);
        if (random() % 8 == 0) ray.t_max = ray.t_min + uniform(random, 0, 1);
        return ray;
    };
}

inline PrimitiveTable random_triangles(int count, double reach, double size, std::uint64_t seed) {
    RandomEngine random(seed);
    TableBuilder builder;
    for (int i = 0; i < count; ++i) {
        const Vec3 a = uniform_point(random, reach);
        builder.add_triangle(a, a + uniform_point(random, size), a + uniform_point(random, size),
                             random() % 3 != 0);
    }
    return builder.finish();
}

inline PrimitiveTable random_spheres(int count, double reach, double size, std::uint64_t seed) {
    RandomEngine random(seed);
    TableBuilder builder;
    for (int i = 0; i < count; ++i) {
        builder.add_sphere(uniform_point(random, reach), uniform(random, 0.1 * size, size),
                           random() % 3 != 0);
    }
    return builder.finish();
}

inline PrimitiveTable random_mixture(int count, double reach, double size, std::uint64_t seed) {
    RandomEngine random(seed);
    TableBuilder builder;
    Placement placement;
    placement.outer_from_inner.linear = {{1, 0.5, 0}, {0, 2, 0.25}, {0.5, 0, 0.5}};
    placement.outer_from_inner.translation = {reach / 4, 0, 0};
    placement.inner_from_outer = inverse(placement.outer_from_inner);
    builder.table.placements.push_back(placement);
    for (int i = 0; i < count; ++i) {
        const Vec3 p = uniform_point(random, reach);
        const bool opaque = random() % 3 != 0;
        switch (random() % 4) {
            case 0:
                builder.add_sphere(p, uniform(random, 0.1 * size, size), opaque);
                break;
            case 1:
                builder.add_sphere(0.3 * p, uniform(random, 0.1 * size, size), opaque, 0);
                break;
            default:
                builder.add_triangle(p, p + uniform_point(random, size),
                                     p + uniform_point(random, size), opaque);
        }
    }
    builder.add_plane({0, 0, -reach}, {0, 0.1, 1}, true);
    builder.add_plane({0, 0, 0.1 * reach}, {1, 0, 1}, false);
    return builder.finish();
}

}  // namespace alhazen::testing
