#pragma once
/// Scenes and rays for the tests of the tracer.

#include <random>
#include <utility>
#include <vector>

#include "alhazen/tracer/tracer.h"

namespace alhazen::testing {

inline double uniform(std::mt19937_64& random, double reach) {
    return reach * (static_cast<double>(random() >> 11) * 0x1p-52 - 1.0);
}
inline Vec3 uniform_point(std::mt19937_64& random, double reach) {
    const double x = uniform(random, reach);
    const double y = uniform(random, reach);
    return {x, y, uniform(random, reach)};
}

/// Every kind of leaf: triangles in float and in double, spheres, other shapes, a plane, instances.
/// Within a cube of about half side 10, except the plane.
inline TracerScene mixed_scene(std::uint64_t seed, int triangle_count = 200) {
    std::mt19937_64 random(seed);
    std::vector<Vec3> positions;
    std::vector<std::array<std::uint32_t, 3>> triangles;
    for (int i = 0; i < triangle_count; ++i) {
        const Vec3 center = uniform_point(random, 8);
        const auto first = static_cast<std::uint32_t>(positions.size());
        for (int k = 0; k < 3; ++k) positions.push_back(center + uniform_point(random, 1.5));
        triangles.push_back({first, first + 1, first + 2});
    }
    TracerScene inner;
    inner.add_mesh(positions, triangles);
    inner.add(Cylinder{.base = {0, 0, -1}, .top = {0, 1, 2}, .radius = 0.7});

    TracerScene scene;
    scene.add_sphere({0, 0, 0}, 1);
    for (int i = 0; i < 20; ++i) {
        scene.add_sphere(uniform_point(random, 8), 0.2 + 0.001 * double(random() % 1000));
    }
    scene.add_mesh(positions, triangles);
    std::vector<float> lattice;
    std::vector<std::uint32_t> indices;
    for (std::uint32_t i = 0; i < 60; ++i) {
        for (int k = 0; k < 9; ++k) lattice.push_back(float(int(random() % 9) - 4));
        for (std::uint32_t k = 0; k < 3; ++k) indices.push_back(3 * i + k);
    }
    scene.add_mesh(lattice, indices);
    scene.add(Plane{.point = {0, 0, -12}});
    scene.add(Cone{.base = {3, 3, 3}, .top = {5, 3, 3}});
    scene.add(Disc{}, {.world_from_geometry = Affine::translate({0, 7, 1})});
    const Tracer instanced(std::move(inner));
    scene.add_instance(instanced, {.world_from_geometry = Affine::scale({0.3, 0.4, 0.3})});
    scene.add_instance(instanced, {.world_from_geometry = Affine::translate({5, 1, 1}) *
                                                          Affine::rotate({1, 2, 3}, 0.7) *
                                                          Affine::scale({-0.2, 0.2, 0.2})});
    return scene;
}

/// Random rays, some along the axes and on the lattice.
inline std::vector<Ray> random_rays(std::uint64_t seed, std::size_t count) {
    std::mt19937_64 random(seed);
    std::vector<Ray> rays;
    for (std::size_t i = 0; i < count; ++i) {
        Ray ray{uniform_point(random, 12), uniform_point(random, 1)};
        if (i % 4 == 0) {
            for (int k = 0; k < 3; ++k) ray.origin[k] = std::round(ray.origin[k]);
            ray.direction = {0, i % 8 == 0 ? -0.0 : 0.0, 0};
            ray.direction[int(i / 4 % 3)] = i % 8 == 0 ? -1 : 1;
        }
        if (i % 5 == 0) ray.t_max = 10;
        rays.push_back(ray);
    }
    return rays;
}

/// Returns whether all bits are equal.
inline bool same_hit(const Hit& a, const Hit& b) {
    return a.t == b.t && a.u == b.u && a.v == b.v && a.part == b.part &&
           a.primitive == b.primitive && a.path == b.path;
}

}  // namespace alhazen::testing
