// Rays that leave a surface do not hit it again: Precision::Fast, whose test is in float.

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>

#include "alhazen/simd/targets.h"
#include "unit/tracer/tracer_cases.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using namespace testing;

Vec3 unit_direction(std::mt19937_64& random) {
    for (;;) {
        const Vec3 v = uniform_point(random, 1);
        const double square = length_squared(v);
        if (square > 0.01 && square <= 1.0) return v / std::sqrt(square);
    }
}

Tracer fast_tracer(TracerScene scene) {
    return Tracer(std::move(scene), {.build = {.precision = Precision::Fast}});
}

/// A mesh that shares no vertices.
class Soup {
  public:
    void add(const Vec3& a, const Vec3& b, const Vec3& c) {
        const auto first = static_cast<std::uint32_t>(positions_.size());
        for (const Vec3& p : {a, b, c}) positions_.push_back(p);
        triangles_.push_back({first, first + 1, first + 2});
    }
    [[nodiscard]] TracerScene scene() const {
        TracerScene scene;
        scene.add_mesh(positions_, triangles_);
        return scene;
    }

  private:
    std::vector<Vec3> positions_;
    std::vector<std::array<std::uint32_t, 3>> triangles_;
};

/// Directions on the side of the normal: any, and nearly along the surface.
Vec3 leaving_direction(std::mt19937_64& random, const Vec3& normal, const Vec3& edge) {
    Vec3 d = unit_direction(random);
    const auto kind = random() % 4;
    if (kind != 0) {
        const Vec3 along = kind == 1 ? edge : d - dot(d, normal) * normal;
        d = normalize(along) + std::pow(10.0, -8.0 * std::abs(uniform(random, 1))) * normal;
    }
    return dot(d, normal) < 0 ? -d : d;
}

struct Count {
    int hits = 0, again = 0;
};

/// Leaves the point of triangle 0 with these weights. The ray that finds it comes from above.
void leave(const Tracer& tracer, std::mt19937_64& random, const Vec3 (&corner)[3], Count& count) {
    double u = 0.5 + uniform(random, 0.5), v = 0.5 + uniform(random, 0.5);
    if (u + v > 1) u = 1 - u, v = 1 - v;
    if (random() % 8 == 0) u = 0.001;
    const Vec3 p = corner[0] + u * (corner[1] - corner[0]) + v * (corner[2] - corner[0]);
    const Vec3 normal = normalize(cross(corner[1] - corner[0], corner[2] - corner[0]));
    Ray ray{p + length(corner[1] - corner[0]) * (normal + 0.3 * unit_direction(random)), {}};
    ray.direction = p - ray.origin;
    Hit hit;
    if (!tracer.intersect(ray, hit) || tracer.ids(hit).primitive != 0) return;
    const HitDetails at = tracer.details(ray, hit);
    for (int i = 0; i < 8; ++i) {
        const Vec3 d = leaving_direction(random, normal, corner[1] - corner[0]);
        ++count.hits;
        const Ray leaving = leaving_ray(at, d);
        Hit next;
        count.again += tracer.intersect(leaving, next) && tracer.ids(next).primitive == 0;
    }
}

TEST(LeavingRays, InFloatMissTheTriangleThatTheyLeave) {
    for (const std::string& target : simd_targets()) {
        const SimdTargetOverride use(target);
        std::mt19937_64 random(5);
        for (const double away : {0.0, 1e6}) {
            for (const double size : {1.0, 1e-2, 1e-4}) {
                for (const double width : {1.0, 1e-2, 1e-4}) {
                    Count count;
                    for (int scene = 0; scene < 12; ++scene) {
                        const Vec3 center = away * Vec3{1, 0.5, -0.7};
                        Vec3 x = unit_direction(random);
                        Vec3 y = unit_direction(random);
                        if (scene % 3 == 0) x = {1, 0, 0}, y = {0, 1, 0};
                        y = normalize(y - dot(x, y) * x);
                        const Vec3 a = center + (1 - size) * uniform_point(random, 0.6);
                        const double top = 0.5 + uniform(random, 0.5);
                        const Vec3 corner[3] = {a, a + size * x, a + size * (top * x + width * y)};
                        Soup soup;
                        soup.add(corner[0], corner[1], corner[2]);
                        for (const double end : {-1.0, 1.0}) {  // fix the size of the scene
                            const Vec3 p = center + end * Vec3{1, 1, 1};
                            soup.add(p, p + Vec3{1e-6, 0, 0}, p + Vec3{0, 1e-6, 0});
                        }
                        const Tracer tracer = fast_tracer(soup.scene());
                        for (int i = 0; i < 40; ++i) leave(tracer, random, corner, count);
                    }
                    // Fewer where float loses the triangle.
                    EXPECT_GT(count.hits, size * width < 1e-5 ? -1 : 1000) << target << size;
                    EXPECT_EQ(count.again, 0) << target << " of " << count.hits << ", size " << size
                                              << ", width " << width << ", away " << away;
                }
            }
        }
    }
}

/// A sphere of triangles.
TracerScene ball(const Vec3& center, double radius) {
    constexpr int kRings = 20, kSectors = 40;
    const auto point = [&](int ring, int sector) {
        const double a = 3.14159265358979 * ring / kRings;
        const double b = 2 * 3.14159265358979 * (sector % kSectors) / kSectors;
        return center +
               radius * Vec3{std::sin(a) * std::cos(b), std::sin(a) * std::sin(b), std::cos(a)};
    };
    Soup soup;
    for (int ring = 0; ring < kRings; ++ring) {
        for (int sector = 0; sector < kSectors; ++sector) {
            const Vec3 p = point(ring, sector), q = point(ring + 1, sector);
            const Vec3 r = point(ring + 1, sector + 1), s = point(ring, sector + 1);
            if (ring + 1 < kRings) soup.add(p, q, r);
            if (ring > 0) soup.add(p, r, s);
        }
    }
    return soup.scene();
}

/// The number of rays from a convex body that hit it again.
Count leave_body(const Tracer& tracer, const Vec3& center, double radius) {
    std::mt19937_64 random(6);
    Count count;
    for (int i = 0; i < 2000; ++i) {
        Ray ray{center + 3 * radius * unit_direction(random), {}};
        ray.direction = center + radius * uniform_point(random, 0.5) - ray.origin;
        Hit hit;
        if (!tracer.intersect(ray, hit)) continue;
        ++count.hits;
        const HitDetails at = tracer.details(ray, hit);
        const Vec3 normal = dot(at.normal, ray.direction) < 0 ? at.normal : -at.normal;
        const Vec3 d = leaving_direction(random, normal, {0.3, 0.2, 0.9});
        count.again += tracer.occluded(leaving_ray(at, d));
    }
    return count;
}

TEST(LeavingRays, InFloatMissTheConvexMeshThatTheyLeave) {
    for (const std::string& target : simd_targets()) {
        const SimdTargetOverride use(target);
        for (const Vec3& center : {Vec3{}, Vec3{1e4, -2e3, 77}}) {
            for (const double radius : {1e-8, 1.0, 1e8}) {
                const Vec3 c = radius * center;
                const Count count = leave_body(fast_tracer(ball(c, radius)), c, radius);
                EXPECT_GT(count.hits, 1900);
                EXPECT_EQ(count.again, 0) << target << ", radius " << radius << " at " << c.x;
            }
        }
    }
}

TEST(LeavingRays, InFloatMissTheInstanceThatTheyLeave) {
    const Tracer inner = fast_tracer(ball({3, 0, 0}, 1));
    const Affine placed = Affine::translate({5, 60, 1}) * Affine::rotate({1, 2, 3}, 0.7) *
                          Affine::scale({-0.02, 0.02, 0.02});
    TracerScene scene;
    scene.add_instance(inner, {.world_from_geometry = placed});
    // The outer test in double.
    const Count count = leave_body(Tracer(std::move(scene)), placed.point({3, 0, 0}), 0.02);
    EXPECT_GT(count.hits, 1900);
    EXPECT_EQ(count.again, 0);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
