#pragma once
/// Asks two aggregates the same and says where they differ; and the tables and rays that most tests
/// of that use.

#include <algorithm>
#include <cstring>
#include <functional>
#include <limits>
#include <sstream>

#include "unit/aggregate/random_tables.h"

namespace alhazen::testing {

inline std::string show(const Vec3& v) {
    std::ostringstream out;
    out << std::hexfloat << "{" << v.x << ", " << v.y << ", " << v.z << "}";
    return out.str();
}
inline std::string show(const Ray& ray) {
    std::ostringstream out;
    out << "origin " << show(ray.origin) << " direction " << show(ray.direction) << " t "
        << std::hexfloat << ray.t_min << " to " << ray.t_max;
    return out.str();
}
inline std::string show(const Hit& hit) {
    std::ostringstream out;
    out << "primitive " << static_cast<std::uint32_t>(hit.primitive) << " t " << std::hexfloat
        << hit.t << " u " << hit.u << " v " << hit.v << " part " << hit.part;
    return out.str();
}
inline bool same_bits(double a, double b) {
    return std::memcmp(&a, &b, sizeof(a)) == 0;
}
inline bool same(const Hit& a, const Hit& b) {
    return a.primitive == b.primitive && same_bits(a.t, b.t) && same_bits(a.u, b.u) &&
           same_bits(a.v, b.v) && a.part == b.part && a.path == b.path;
}

/// What an aggregate says about a ray.
struct Answer {
    Hit closest;
    bool found = false, occluded = false, shadowed = false;
    std::vector<Hit> all, crossings;
};

inline Answer ask(const Aggregate& aggregate, const Ray& ray, RayMask mask = kAllRays) {
    Answer answer;
    const RayQuery query{nullptr, mask};
    answer.found = aggregate.closest(ray, answer.closest, query);
    answer.occluded = aggregate.occluded(ray, query);
    aggregate.all_hits(ray, answer.all, query);
    answer.shadowed = aggregate.shadowed(ray, answer.crossings, query);
    if (answer.shadowed) answer.crossings.clear();  // meaningless then
    return answer;
}

/// What went differently; empty when nothing did.
inline std::string difference(const Answer& list, const Answer& tested) {
    const auto same_all = [](const std::vector<Hit>& a, const std::vector<Hit>& b) {
        return std::equal(a.begin(), a.end(), b.begin(), b.end(), same);
    };
    if (tested.found != list.found || !same(list.closest, tested.closest)) {
        return "closest: " + show(list.closest) + " became " + show(tested.closest);
    }
    if (tested.occluded != list.occluded || list.occluded != list.found) return "occluded";
    if (!same_all(list.all, tested.all)) {
        return "all hits: " + std::to_string(list.all.size()) + " became " +
               std::to_string(tested.all.size());
    }
    if (list.shadowed != tested.shadowed) return "shadowed";
    if (!same_all(list.crossings, tested.crossings)) return "crossings of a shadow ray";
    return "";
}

using MakeRay = std::function<Ray(Random&)>;

inline MakeRay random_rays(double reach) {
    return [reach](Random& random) {
        Ray ray{uniform_point(random, 2 * reach), {}, 0, std::numeric_limits<double>::infinity()};
        ray.direction = uniform_point(random, reach) - ray.origin;
        if (random() % 4 == 0) ray.direction = normalize(ray.direction);
        if (random() % 8 == 0) ray.t_min = uniform(random, 0, 0.5);
        if (random() % 8 == 0) ray.t_max = ray.t_min + uniform(random, 0, 1);
        return ray;
    };
}

inline PrimitiveTable random_triangles(int count, double reach, double size, std::uint64_t seed) {
    Random random(seed);
    TableBuilder builder;
    for (int i = 0; i < count; ++i) {
        const Vec3 a = uniform_point(random, reach);
        builder.add_triangle(a, a + uniform_point(random, size), a + uniform_point(random, size),
                             random() % 3 != 0);
    }
    return builder.finish();
}

inline PrimitiveTable random_spheres(int count, double reach, double size, std::uint64_t seed) {
    Random random(seed);
    TableBuilder builder;
    for (int i = 0; i < count; ++i) {
        builder.add_sphere(uniform_point(random, reach), uniform(random, 0.1 * size, size),
                           random() % 3 != 0);
    }
    return builder.finish();
}

inline PrimitiveTable random_mixture(int count, double reach, double size, std::uint64_t seed) {
    Random random(seed);
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
