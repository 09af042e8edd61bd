#include "alhazen/renderers/cone_tracing/cone_containment.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "alhazen/geometry/watertight_triangle.h"
#include "alhazen/math/constants.h"

namespace alhazen {

namespace {

constexpr std::uint32_t kNoTriangle = 0xFFFFFFFFu;

/// Calls `visit` with each item of the tree whose leaf's box passes `test`.
template <class Test, class Visit>
void for_items(const ConeTree& tree, const Test& test, const Visit& visit) {
    if (tree.empty()) return;
    std::vector<std::uint32_t> waiting{0};
    while (!waiting.empty()) {
        const ConeTree::Node& node = tree.node(waiting.back());
        waiting.pop_back();
        if (!test(node)) continue;
        if (node.count == 0) {
            waiting.push_back(node.first);
            waiting.push_back(node.first + 1);
        }
        for (std::uint32_t k = 0; k < node.count; ++k) visit(tree.item(node.first + k));
    }
}

/// True if the edge from `a` to `b` passes `p` on the side of greater y, in the plane of y and z.
/// Both directions of an edge have the same answer.
bool passes_above(Vec3 a, Vec3 b, const Vec3& p) {
    if ((a.z > p.z) == (b.z > p.z)) return false;
    if (b.z < a.z) std::swap(a, b);
    return (p.z - a.z) * (b.y - a.y) > (p.y - a.y) * (b.z - a.z);
}

/// True if the line from `p` along x crosses the triangle.
bool crosses(const std::array<Vec3, 3>& t, const Vec3& p) {
    bool in = false;
    for (std::size_t k = 0; k < 3; ++k) in ^= passes_above(t[k], t[(k + 1) % 3], p);
    if (!in) return false;
    const Vec3 normal = cross(t[1] - t[0], t[2] - t[0]);
    // The distance along x to the plane, times the x of the normal.
    return (dot(normal, t[0] - p) > 0.0) == (normal.x > 0.0);
}

/// True if the line from `p` along x crosses an odd number of triangles, without the one numbered
/// `but`.
bool crosses_odd(const ConeTree& tree, const TriangleMesh& mesh, const Vec3& p, std::uint32_t but) {
    bool odd = false;
    const auto meets_line = [&](const ConeTree::Node& node) {
        return std::abs(p.y - node.center.y) <= node.half.y &&
               std::abs(p.z - node.center.z) <= node.half.z && p.x <= node.center.x + node.half.x;
    };
    for_items(tree, meets_line, [&](std::uint32_t k) {
        if (k == but) return;
        const auto& t = mesh.triangles[k];
        odd ^= crosses({mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]}, p);
    });
    return odd;
}

bool contains(const ConeSource& source, const TriangleMesh& mesh, const Vec3& point) {
    const Vec3 p = source.placed ? source.placement.inner_from_outer.point(point) : point;
    return crosses_odd(*source.tree, mesh, p, kNoTriangle);
}

bool contains(const ConeScene& scene, const ConeSolid& solid, const Vec3& p) {
    const ConeSource& source = scene.sources[solid.source];
    switch (source.kind) {
        case ConeSource::Kind::Sphere:
            return length_squared(p - source.point) <= source.radius * source.radius;
        case ConeSource::Kind::Plane:
            return dot(p - source.point, source.normal) <= 0.0;
        case ConeSource::Kind::Faces:
            for (std::uint32_t k = solid.first_face; k < solid.end_face; ++k) {
                const ConeFace& face = scene.faces[k];
                const double height = dot(p - face.point, face.normal);
                if (source.inward ? !(height >= 0.0) : !(height <= 0.0)) return false;
            }
            return true;
        case ConeSource::Kind::Mesh:
            return contains(source, *source.mesh.mesh, p);
    }
    return false;
}

/// True if the ray meets the box of a node before `t_max`.
bool meets(const ConeTree::Node& node, const Ray& ray, double t_max) {
    double from = 0.0, to = t_max;
    for (int axis = 0; axis < 3; ++axis) {
        const double place = node.center[axis] - ray.origin[axis];
        const double d = ray.direction[axis];
        if (d == 0.0) {
            if (std::abs(place) > node.half[axis]) return false;
            continue;
        }
        const double middle = place / d, half = node.half[axis] / std::abs(d);
        from = std::max(from, middle - half);
        to = std::min(to, middle + half);
    }
    return from <= to;
}

ConeWall wall_of_mesh(const ConeSource& source, std::uint32_t part, const Ray& ray) {
    const TriangleMesh& mesh = *source.mesh.mesh;
    Ray inner = source.placed ? transformed(source.placement.inner_from_outer, ray) : ray;
    ConeWall wall{.t = ray.t_max, .part = part};
    const RayShear shear(inner.direction);
    const auto is_met = [&](const ConeTree::Node& node) { return meets(node, inner, inner.t_max); };
    for_items(*source.tree, is_met, [&](std::uint32_t k) {
        if (k == part) return;
        const auto& t = mesh.triangles[k];
        ShapeHit hit;
        if (intersect_triangle(inner, shear, mesh.positions[t[0]], mesh.positions[t[1]],
                               mesh.positions[t[2]], hit)) {
            inner.t_max = hit.t;
            wall = {hit.t, k, hit.u, hit.v};
        }
    });
    return wall;
}

}  // namespace

bool contains_point(const ConeScene& scene, std::uint32_t source, const Vec3& point) {
    const ConeSource& s = scene.sources[source];
    return contains(scene,
                    s.kind == ConeSource::Kind::Plane ? ConeSolid{source} : scene.solids[s.solid],
                    point);
}

bool faces_inward(const ConeTree& tree, const TriangleMesh& mesh, std::uint32_t triangle) {
    const auto& t = mesh.triangles[triangle];
    const Vec3 &a = mesh.positions[t[0]], &b = mesh.positions[t[1]], &c = mesh.positions[t[2]];
    const bool is_inside_ahead = crosses_odd(tree, mesh, (a + b + c) / 3.0, triangle);
    return is_inside_ahead == (cross(b - a, c - a).x > 0.0);
}

ConeWall wall_ahead(const ConeScene& scene, std::uint32_t source, std::uint32_t part,
                    const Ray& ray) {
    const ConeSource& s = scene.sources[source];
    switch (s.kind) {
        case ConeSource::Kind::Sphere: {
            const Vec3 from = ray.origin - s.point;
            const double a = length_squared(ray.direction), b = dot(from, ray.direction);
            const double beyond = s.radius * s.radius - length_squared(from);
            const double root = std::sqrt(std::max(b * b + a * beyond, 0.0));
            return {.t = std::clamp((root - b) / a, 0.0, ray.t_max)};
        }
        case ConeSource::Kind::Plane: {
            const double along = dot(ray.direction, s.normal);
            const double t = along > 0.0 ? dot(s.point - ray.origin, s.normal) / along : ray.t_max;
            return {.t = std::clamp(t, 0.0, ray.t_max)};
        }
        case ConeSource::Kind::Faces: {
            ConeWall wall{.t = ray.t_max, .part = part};
            const ConeSolid& solid = scene.solids[s.solid];
            for (std::uint32_t k = solid.first_face; k < solid.end_face; ++k) {
                const ConeFace& face = scene.faces[k];
                const Vec3 outward = s.inward ? -face.normal : face.normal;
                const double along = dot(ray.direction, outward);
                if (!(along > 0.0)) continue;
                const double t = dot(face.point - ray.origin, outward) / along;
                if (t < wall.t) wall = {.t = t, .part = face.part};
            }
            wall.t = std::max(wall.t, 0.0);
            return wall;
        }
        case ConeSource::Kind::Mesh:
            return wall_of_mesh(s, part, ray);
    }
    return {.t = ray.t_max};
}

SolidsAround solids_around(const ConeScene& scene, const Vec3& point) {
    struct Around {
        std::uint32_t source;
        double size;
    };
    std::vector<Around> around;
    const auto add = [&](const ConeSolid& solid, double size) {
        if (contains(scene, solid, point)) around.push_back({solid.source, size});
    };
    for (const std::uint32_t source : scene.planes) {
        if (scene.sources[source].closed) add({source}, kInfinity);
    }
    const auto holds_point = [&](const ConeTree::Node& node) {
        const Vec3 d = point - node.center;
        return std::abs(d.x) <= node.half.x && std::abs(d.y) <= node.half.y &&
               std::abs(d.z) <= node.half.z;
    };
    for_items(scene.solid_tree, holds_point,
              [&](std::uint32_t k) { add(scene.solids[k], scene.solids[k].size); });
    std::stable_sort(around.begin(), around.end(),
                     [](const Around& a, const Around& b) { return a.size < b.size; });
    SolidsAround result;
    for (const Around& solid : around) {
        if (!result.full()) result.push_back(solid.source);
    }
    return result;
}

}  // namespace alhazen
