#pragma once
/// Scenes and rays on which every accelerator must have the results of brute force: random, on a
/// lattice, empty, of one primitive, coincident, flat, huge, tiny, nested; rays inside, on faces,
/// axis-parallel, with -0.0, from far away, to lights.

#include <cmath>

#include "unit/aggregates/compare_aggregates.h"

namespace alhazen::testing {

struct ConformanceScene {
    std::string name;
    PrimitiveTable table;
    MakeRay rays;
};

/// Axis-parallel and diagonal rays between lattice points, with zeros of both signs.
inline MakeRay lattice_rays(int reach) {
    return [reach](RandomEngine& random) {
        Ray ray{lattice_point(random, 2 * reach), {}, 0, std::numeric_limits<double>::infinity()};
        for (int k = 0; k < 3; ++k) {
            constexpr double kComponents[] = {0.0, -0.0, 0.0, -0.0, 1.0, -1.0, 2.0, -0x1p-1070};
            ray.direction[k] = kComponents[random() % 8];
        }
        if (ray.direction == Vec3{}) ray.direction.x = random() % 2 == 0 ? 1.0 : -1.0;
        if (random() % 4 == 0) ray.t_max = uniform_int(random, 0, 4);
        return ray;
    };
}

/// Rays towards the unit cube from `distance`, some exactly along an axis.
inline MakeRay rays_from(double distance) {
    return [distance](RandomEngine& random) {
        Ray ray{distance * uniform_point(random, 1), {}, 0, 1e300};
        if (random() % 3 == 0) {
            const int axis = uniform_int(random, 0, 2);
            ray.origin = uniform_point(random, 1);
            ray.origin[axis] = distance;
            ray.direction[axis] = -1;
            return ray;
        }
        ray.direction = uniform_point(random, 1) - ray.origin;
        return ray;
    };
}

inline PrimitiveTable lattice_table() {
    RandomEngine random(14);
    TableBuilder builder;
    for (int i = 0; i < 300; ++i) {
        const Vec3 a = lattice_point(random, 3);
        builder.add_triangle(a, a + lattice_point(random, 1), a + lattice_point(random, 1),
                             random() % 2 == 0);
        if (i % 4 == 0) builder.add_sphere(a, uniform_int(random, 1, 2) * 0.5, random() % 2 == 0);
    }
    return builder.finish();
}

inline PrimitiveTable flat_table() {
    TableBuilder builder;
    for (int x = -6; x < 6; ++x) {
        for (int y = -6; y < 6; ++y) {
            const Vec3 p{double(x), double(y), 0};
            builder.add_triangle(p, p + Vec3{1, 0, 0}, p + Vec3{1, 1, 0});
            builder.add_triangle(p, p + Vec3{1, 1, 0}, p + Vec3{0, 1, 0});
        }
    }
    return builder.finish();
}

inline PrimitiveTable coincident_table() {
    TableBuilder builder;
    for (int i = 0; i < 100; ++i) {
        builder.add_triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, i > 50);
        builder.add_sphere({2, 0, 0}, 0.5, i > 50);
    }
    return builder.finish();
}

inline PrimitiveTable nested_scales_table() {
    RandomEngine random(16);
    TableBuilder builder;
    for (double scale = 1e-6; scale < 2e6; scale *= 10) {
        for (int i = 0; i < 20; ++i) {
            const Vec3 a = uniform_point(random, scale);
            builder.add_triangle(a, a + uniform_point(random, scale),
                                 a + uniform_point(random, scale), random() % 2 == 0);
        }
    }
    return builder.finish();
}

inline PrimitiveTable sticks_table() {
    RandomEngine random(18);
    TableBuilder builder;
    for (int i = 0; i < 200; ++i) {
        const Vec3 a = uniform_point(random, 1);
        const Vec3 thin = uniform_point(random, 0.003);
        const bool flag = random() % 2 == 0;
        builder.add_triangle(a, uniform_point(random, 1), a + thin, flag);
    }
    return builder.finish();
}

inline PrimitiveTable far_table(const Vec3& there) {
    RandomEngine random(18);
    TableBuilder builder;
    for (int i = 0; i < 150; ++i) {
        const Vec3 a = there + uniform_point(random, 1);
        builder.add_triangle(a, a + uniform_point(random, 0.3), a + uniform_point(random, 0.3));
        builder.add_sphere(a, 0.1);
    }
    return builder.finish();
}

/// Lights registered in the table, some close behind large triangles.
inline PrimitiveTable lit_table() {
    RandomEngine random(19);
    TableBuilder builder;
    for (int i = 0; i < 200; ++i) {
        const Vec3 a = uniform_point(random, 1);
        builder.add_triangle(a, a + uniform_point(random, 0.3), a + uniform_point(random, 0.3),
                             random() % 3 != 0);
        if (i % 4 == 0) builder.add_sphere(a, 0.1, random() % 3 != 0);
    }
    builder.add_triangle({-2, -2, 1.5}, {2, -2, 1.5}, {0, 3, 1.5});
    builder.add_triangle({1, 0.2, -0.5}, {0.2, 0, -1}, {1, -1, -1});
    builder.add_triangle({-1, -1, 0}, {-1, 1, 0}, {-1, 0, 2}, false);
    builder.table.known_ray_ends = {
        {{0, 0, 2}}, {{1, 0, -1}}, {{-1.25, 0, 0.5}}, {{0, 0, 1}, true}};
    return builder.finish();
}

/// Shadow rays to each of the lights from anywhere; some miss the light slightly, end before it or
/// beyond it.
inline MakeRay rays_to(std::vector<RayEnd> ends) {
    return [ends = std::move(ends)](RandomEngine& random) {
        const RayEnd& end = ends[random() % ends.size()];
        Ray ray{uniform_point(random, 2), end.place, 0x1p-1000, 1e300};
        if (end.at_infinity) return ray;
        ray.direction = end.place - ray.origin;
        ray.t_max = 1;
        if (random() % 2 == 0) {
            ray.t_max = length(ray.direction);
            ray.direction = normalize(ray.direction);
        }
        if (random() % 4 == 0) ray.direction = ray.direction + uniform_point(random, 1e-13);
        if (random() % 4 == 0) ray.t_max *= uniform(random, 0.1, 1.5);
        if (random() % 4 == 0) ray.t_min = 0.5 * ray.t_max;
        return ray;
    };
}

inline std::vector<ConformanceScene> conformance_scenes() {
    std::vector<ConformanceScene> scenes;
    const auto add = [&](std::string name, PrimitiveTable table, MakeRay rays) {
        scenes.push_back({std::move(name), std::move(table), std::move(rays)});
    };
    add("nothing", TableBuilder{}.finish(), random_rays(1));
    add("one triangle", random_triangles(1, 0.1, 1, 20), random_rays(1));
    add("one sphere", random_spheres(1, 0.1, 1, 20), random_rays(1));
    add("two triangles", random_triangles(2, 1, 0.5, 11), random_rays(1));
    add("triangles", random_triangles(500, 1, 0.3, 11), random_rays(1));
    add("spheres", random_spheres(300, 1, 0.2, 12), random_rays(1));
    add("mixture with planes", random_mixture(300, 1, 0.3, 13), random_rays(1));
    add("lattice, lattice rays", lattice_table(), lattice_rays(3));
    add("lattice, random rays", lattice_table(), random_rays(3));
    add("flat, lattice rays", flat_table(), lattice_rays(6));
    add("flat, random rays", flat_table(), random_rays(6));
    add("coincident", coincident_table(), random_rays(1.5));
    add("nested scales", nested_scales_table(), random_rays(1));
    add("nested scales, from outside", nested_scales_table(), random_rays(1e6));
    add("sticks", sticks_table(), random_rays(1));
    add("rays to lights", lit_table(), rays_to(lit_table().known_ray_ends));
    for (const double size : {1e-100, 1e-6, 1e6, 1e100}) {
        std::ostringstream name;
        name << "size " << size;
        add(name.str(), random_mixture(100, size, 0.3 * size, 15), random_rays(size));
    }
    for (const double distance : {1e3, 1e6, 1e12, 1e30}) {
        std::ostringstream name;
        name << "rays from " << distance;
        add(name.str(), random_mixture(100, 1, 0.5, 17), rays_from(distance));
    }
    const Vec3 there{1e8, -3e8, 2e8};
    add("far from the origin", far_table(there), [there](RandomEngine& random) {
        Ray ray{there + uniform_point(random, 2), {}, 0, 1e300};
        ray.direction = there + uniform_point(random, 1) - ray.origin;
        return ray;
    });
    return scenes;
}

}  // namespace alhazen::testing
