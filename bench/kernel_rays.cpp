#include "kernel_rays.h"

#include <cmath>
#include <numbers>
#include <utility>

#include "alhazen/cameras/camera.h"
#include "alhazen/primitives/surface.h"
#include "alhazen/sampling/random.h"
#include "mesh_makers.h"

namespace alhazen::bench {

namespace {

Ray float_ray(const Vec3& origin, const Vec3& direction, double t_min, double t_max) {
    return {to_float(origin), to_float(direction), to_float(t_min), to_float(t_max)};
}

Vec3 cosine_direction(const Vec3& normal, RandomStream& random) {
    const double r = std::sqrt(random.uniform());
    const double phi = random.uniform(0.0, 2.0 * std::numbers::pi);
    const Vec3 u = perpendicular(normal);
    const Vec3 v = cross(normal, u);
    return r * std::cos(phi) * u + r * std::sin(phi) * v + std::sqrt(1.0 - r * r) * normal;
}

}  // namespace

std::vector<RaySet> ray_sets(const KernelScene& scene, const Aggregate& aggregate, int side) {
    RandomStream random(1);
    const Box3 box = scene.box();
    const double size = length(box.size());
    const double start = scene.ray_start;
    const Camera camera = look_along(scene.eye, scene.look_at - scene.eye, {0, 1, 0.01}, 0.7, 1.0);
    RaySet eye{"eye", false, true, {}}, shadow{"shadow", true, true, {}};
    RaySet bounce{"bounce", false, false, {}};
    for (int ty = 0; ty < side; ty += 8) {
        for (int tx = 0; tx < side; tx += 8) {
            for (int i = 0; i < 64; ++i) {
                const Ray r = eye_ray(camera, (tx + i % 8 + 0.5) / side, (ty + i / 8 + 0.5) / side);
                eye.rays.push_back(float_ray(r.origin, r.direction, 0, HUGE_VAL));
                Hit hit;
                if (!aggregate.closest(eye.rays.back(), hit, nullptr)) continue;
                const Surface s = surface_at(aggregate, eye.rays.back(), hit);
                const Vec3 normal = dot(s.normal, r.direction) > 0 ? -s.normal : s.normal;
                const Vec3 to_light = scene.light - s.point;
                shadow.rays.push_back(float_ray(s.point + start * normal, to_light, 0, 1));
                bounce.rays.push_back(float_ray(s.point + start * normal,
                                                cosine_direction(normal, random), 0, HUGE_VAL));
            }
        }
    }
    RaySet shuffled{"shuffled", false, false, bounce.rays};
    for (std::size_t i = shuffled.rays.size(); i > 1; --i) {
        std::swap(shuffled.rays[i - 1], shuffled.rays[random.below(i)]);
    }
    RaySet ambient{"ambient", true, false, bounce.rays};
    RaySet lines{"lines", false, false, {}};
    const auto point = [&] {
        return Vec3{random.uniform(box.lo.x, box.hi.x), random.uniform(box.lo.y, box.hi.y),
                    random.uniform(box.lo.z, box.hi.z)};
    };
    for (std::size_t i = 0; i < bounce.rays.size(); ++i) {
        const Vec3 a = point();
        const Vec3 d = normalize(point() - a);
        lines.rays.push_back(float_ray(a - size * d, d, 0, HUGE_VAL));
    }
    return {std::move(eye),     std::move(shadow),   std::move(bounce),
            std::move(ambient), std::move(shuffled), std::move(lines)};
}

}  // namespace alhazen::bench
