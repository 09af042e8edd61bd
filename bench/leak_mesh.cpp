#include "leak_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "alhazen/base/error.h"
#include "alhazen/parallel/parallel.h"
#include "mesh_makers.h"

namespace alhazen::bench {

namespace {

constexpr std::size_t kCandidates = 2000;
constexpr std::size_t kBalls = 32;

/// Winding number of the mesh around the point.
double winding_number(const TriangleMesh& mesh, const Vec3& p) {
    double angle = 0;
    for (const auto& [i, j, k] : mesh.triangles) {
        const Vec3 a = mesh.positions[i] - p, b = mesh.positions[j] - p, c = mesh.positions[k] - p;
        const double la = length(a), lb = length(b), lc = length(c);
        const double volume = dot(a, cross(b, c));
        const double across = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb;
        angle += 2.0 * std::atan2(volume, across);
    }
    return angle / (4.0 * std::numbers::pi);
}

/// Lower bound of the distance to the nearest triangle: the distance to the nearest triangle's box.
double clearance(const TriangleMesh& mesh, const Vec3& p) {
    double least = HUGE_VAL;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const Box3 box = mesh.triangle_box(i);
        Vec3 away;
        for (int k = 0; k < 3; ++k) {
            away[k] = std::max({0.0, box.lo[k] - p[k], p[k] - box.hi[k]});
        }
        least = std::min(least, length_squared(away));
    }
    return std::sqrt(least);
}

double snapped(double x, double step) {
    return std::nearbyint(x / step) * step;
}

/// A ray from origin to aim. Exact: all coordinates are multiples of the grid step, fewer than 2^24
/// of them.
Ray aimed(const Vec3& origin, const Vec3& aim) {
    const Ray ray{to_float(origin), to_float(aim - origin)};
    if (ray.origin != origin || ray.direction != aim - origin) {
        throw Error(ErrorKind::Resource, "leak rays: a coordinate is not exact in float");
    }
    return ray;
}

}  // namespace

const char* name_of(LeakKind kind) {
    static constexpr std::array<const char*, kLeakKinds> kNames{"vertices", "edges", "axes"};
    return kNames[static_cast<std::size_t>(kind)];
}

LeakMesh::LeakMesh(std::string name, TriangleMesh mesh)
    : name_(std::move(name)), mesh_(std::move(mesh)) {
    mesh_.normals.clear();
    mesh_.uvs.clear();
    snap_to_grid();
    if (!mesh_.closed()) {
        throw Error(ErrorKind::Usage, fmt::format("{}: the mesh is not closed", name_));
    }
    find_balls();
}

void LeakMesh::snap_to_grid() {
    const Box3 box = mesh_.box();
    const double reach = 0.5 * max_component(box.size());
    grid_ = std::exp2(std::ceil(std::log2(reach)) - 23);
    for (Vec3& p : mesh_.positions) {
        for (int k = 0; k < 3; ++k) p[k] = snapped(p[k] - box.center()[k], 8 * grid_);
    }
    // If rounding collapses a triangle to a line, its two neighbours become adjacent.
    std::erase_if(mesh_.triangles, [&](const std::array<std::uint32_t, 3>& t) {
        const Vec3 &a = mesh_.positions[t[0]], &b = mesh_.positions[t[1]],
                   &c = mesh_.positions[t[2]];
        return a == b || b == c || c == a;
    });
}

void LeakMesh::find_balls() {
    RandomStream random(7);
    const Box3 box = mesh_.box();
    std::vector<Ball> candidates(kCandidates);
    for (Ball& ball : candidates) {
        for (int k = 0; k < 3; ++k) {
            ball.center[k] = snapped(random.uniform(box.lo[k], box.hi[k]), grid_);
        }
    }
    parallel_for(candidates.size(), 16, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            candidates[i].radius = clearance(mesh_, candidates[i].center);
        }
    });
    std::sort(candidates.begin(), candidates.end(),
              [](const Ball& a, const Ball& b) { return a.radius > b.radius; });
    for (Ball& ball : candidates) {
        if (balls_.size() == kBalls || ball.radius < 64 * grid_) break;
        if (std::abs(winding_number(mesh_, ball.center)) < 0.5) continue;
        const double half = 0.5 * ball.radius;
        for (int axis = 0; axis < 3; ++axis) {
            const int u = (axis + 1) % 3, v = (axis + 2) % 3;
            for (std::uint32_t i = 0; i < mesh_.positions.size(); ++i) {
                const Vec3 away = abs(mesh_.positions[i] - ball.center);
                if (away[u] <= half && away[v] <= half) ball.lines[axis].push_back(i);
            }
        }
        balls_.push_back(std::move(ball));
    }
    if (balls_.empty()) {
        throw Error(ErrorKind::Usage, fmt::format("{}: no inside point found", name_));
    }
}

Vec3 LeakMesh::point_in(const Ball& ball, RandomStream& random) const {
    Vec3 p;
    for (int k = 0; k < 3; ++k) {
        p[k] = snapped(ball.center[k] + ball.radius * random.uniform(-0.5, 0.5), grid_);
    }
    return p;
}

Ray LeakMesh::axis_ray(const Ball& ball, RandomStream& random) const {
    const auto axis = static_cast<int>(random.below(3));
    const std::vector<std::uint32_t>& lines = ball.lines[axis];
    Vec3 origin = point_in(ball, random);
    if (!lines.empty()) {
        // Half of the rays pass through a vertex, half through coordinates of two vertices.
        const int u = (axis + 1) % 3, v = (axis + 2) % 3;
        const std::uint32_t i = lines[random.below(lines.size())];
        const std::uint32_t j = random.below(2) == 0 ? i : lines[random.below(lines.size())];
        origin[u] = mesh_.positions[i][u];
        origin[v] = mesh_.positions[j][v];
    }
    const double zero = random.below(2) == 0 ? 0.0 : -0.0;
    Ray ray{origin, {zero, zero, zero}};
    ray.direction[axis] = random.below(2) == 0 ? 1.0 : -1.0;
    return ray;
}

Ray LeakMesh::ray(LeakKind kind, RandomStream& random) const {
    const Ball& ball = balls_[random.below(balls_.size())];
    if (kind == LeakKind::Axis) return axis_ray(ball, random);
    const Vec3 origin = point_in(ball, random);
    const auto& triangle = mesh_.triangles[random.below(mesh_.triangles.size())];
    const std::uint64_t corner = random.below(3);
    const Vec3& a = mesh_.positions[triangle[corner]];
    if (kind == LeakKind::Vertex) return aimed(origin, a);
    const Vec3& b = mesh_.positions[triangle[(corner + 1) % 3]];
    const double eighths = static_cast<double>(1 + random.below(7));
    return aimed(origin, a + (eighths / 8.0) * (b - a));
}

}  // namespace alhazen::bench
