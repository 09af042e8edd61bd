#include "alhazen/solids/triangles/face_tests.h"

#include <algorithm>

#include "alhazen/base/interruption.h"
#include "alhazen/math/constants.h"
#include "alhazen/math/unit_vector.h"
#include "alhazen/parallel/parallel.h"

namespace alhazen {

namespace {

/// Faces, or vertices, of one task.
constexpr std::size_t kGrain = 64;

}  // namespace

void FaceTests::test(const std::vector<std::uint32_t>& numbers, std::vector<SurfaceEdge>& edges,
                     const FaceOf& face_of) {
    std::vector<std::uint32_t> vertices;
    for (const std::uint32_t k : numbers) {
        for (const std::uint32_t v : edges[k].vertices) {
            if (!vertices_[v].is_near) vertices.push_back(v);
        }
    }
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    parallel_for(vertices.size(), kGrain, [&](std::size_t first, std::size_t last) {
        SurfaceLine line(solid_);
        for (; first < last; ++first) {
            interruption_point();
            SurfaceVertex& v = vertices_[vertices[first]];
            v.is_near = line.is_near(v.point, v.normal, limit_);
        }
    });
    parallel_for(numbers.size(), kGrain, [&](std::size_t first, std::size_t last) {
        SurfaceLine line(solid_);
        for (; first < last; ++first) {
            interruption_point();
            SurfaceEdge& edge = edges[numbers[first]];
            edge.is_near = is_face_near(edge, face_of(edge), line);
        }
    });
}

double FaceTests::distance_of(const SurfaceFace& face, SurfaceLine& line, double most) const {
    double largest = 0;
    for (std::size_t k = 0; k < face.triangle_count(); ++k) {
        const auto t = face.triangle(k);
        const Vec3 a = point(t[0]), b = point(t[1]), c = point(t[2]);
        const Vec3 normal = unit_or(cross(b - a, c - a), vertices_[t[0]].normal);
        const Vec3 middle = (a + b + c) / 3;
        for (const Vec3& p : {middle, 0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a), a, b, c}) {
            const double distance = line.distance(p, normal, most);
            if (distance < kInfinity) largest = std::max(largest, distance);
        }
    }
    return largest;
}

bool FaceTests::is_face_near(const SurfaceEdge& edge, const SurfaceFace& face,
                             SurfaceLine& line) const {
    for (std::size_t k = 0; k < face.triangle_count(); ++k) {
        const Triangle t = face.triangle(k);
        if (!is_near(t, line) || !is_turned_out(edge, t, line)) return false;
    }
    return true;
}

bool FaceTests::is_turned_out(const SurfaceEdge& edge, const Triangle& t, SurfaceLine& line) const {
    const Vec3 a = point(t[0]), b = point(t[1]), c = point(t[2]);
    const Vec3 normal = unit_or(cross(b - a, c - a), edge.met.normal);
    if (dot(normal, edge.met.normal) > 0.0 && std::all_of(t.begin(), t.end(), [&](std::uint32_t k) {
            return dot(normal, vertices_[k].normal) > 0.0;
        })) {
        return true;
    }
    return line.faces((a + b + c) / 3, normal, limit_);
}

bool FaceTests::is_near(const Triangle& t, SurfaceLine& line) const {
    const Vec3 a = point(t[0]), b = point(t[1]), c = point(t[2]);
    const Vec3 normal = unit_or(cross(b - a, c - a), vertices_[t[0]].normal);
    for (std::size_t k = 0; k < 3; ++k) {
        if (!vertices_[t[k]].is_near) return false;
        const std::uint32_t from = t[k], to = t[(k + 1) % 3];
        if (from > to) continue;
        for (const double share : {0.25, 0.5, 0.75}) {
            if (!line.is_near((1 - share) * point(from) + share * point(to), normal, limit_)) {
                return false;
            }
        }
    }
    return line.is_near(0.25 * (a + b) + 0.5 * c, normal, limit_) &&
           line.is_near(0.25 * (b + c) + 0.5 * a, normal, limit_) &&
           line.is_near(0.25 * (c + a) + 0.5 * b, normal, limit_);
}

}  // namespace alhazen
