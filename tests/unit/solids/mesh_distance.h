#pragma once
/// Distances between meshes, by brute force.

#include <algorithm>
#include <cmath>

#include "alhazen/shapes/meshes/triangle_mesh.h"
#include "support/random.h"

namespace alhazen::testing {

/// Distance of a point from a triangle: along the plane's normal inside, else from the edges.
inline double distance(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3 normal = cross(b - a, c - a);
    const auto outside = [&](const Vec3& from, const Vec3& to) {
        return dot(cross(to - from, p - from), normal) < 0.0;
    };
    if (length_squared(normal) > 0.0 && !outside(a, b) && !outside(b, c) && !outside(c, a)) {
        return std::abs(dot(p - a, normal)) / length(normal);
    }
    const auto from_edge = [&](const Vec3& from, const Vec3& to) {
        const Vec3 along = to - from;
        const double t = dot(p - from, along) / std::max(length_squared(along), 1e-300);
        return length(p - from - std::clamp(t, 0.0, 1.0) * along);
    };
    return std::min({from_edge(a, b), from_edge(b, c), from_edge(c, a)});
}

inline double distance(const Vec3& p, const TriangleMesh& mesh) {
    double least = 1e300;
    for (const auto& [a, b, c] : mesh.triangles) {
        least =
            std::min(least, distance(p, mesh.positions[a], mesh.positions[b], mesh.positions[c]));
    }
    return least;
}

/// Largest distance of `count` random points in each triangle of a mesh, and of its corners, from
/// another mesh.
inline double largest_distance(const TriangleMesh& from, const TriangleMesh& to, int count) {
    Random random(3);
    double most = 0;
    for (const auto& [a, b, c] : from.triangles) {
        most = std::max(most, distance(from.positions[a], to));
        for (int i = 0; i < count; ++i) {
            double u = random.uniform(), v = random.uniform();
            if (u + v > 1) u = 1 - u, v = 1 - v;
            most = std::max(most, distance(u * from.positions[a] + v * from.positions[b] +
                                               (1 - u - v) * from.positions[c],
                                           to));
        }
    }
    return most;
}

}  // namespace alhazen::testing
