#include "alhazen/laboratory/claims/claim_scenes.h"

#include <cmath>

#include "alhazen/math/constants.h"
#include "alhazen/sampling/random.h"

namespace alhazen {
namespace {

SceneDescription empty_scene() {
    SceneDescription scene;
    scene.format = "generated";
    const Vec3 eye{0.5, 0.6, 2.6}, target{0.5, 0.5, 0.5};
    constexpr double kFov = 36.0 / 180.0 * kPi;
    scene.cameras.push_back({"main", look_along(eye, target - eye, {0, 1, 0}, kFov, 1.0), 1.0, {}});
    scene.lights.push_back({"lamp", PointLight{.position = {1.5, 3, 3}, .color = {1, 1, 1}}, {}});
    scene.picture = {256, 256, Rgb{0.02, 0.02, 0.05}};
    Material plain, mirror;
    plain.name = "plain";
    plain.diffuse.color = plain.ambient.color = {0.7, 0.7, 0.75};
    mirror.name = "mirror";
    mirror.diffuse.color = {0.2, 0.2, 0.2};
    mirror.reflective.color = {0.7, 0.7, 0.7};
    scene.materials.push_back({plain, {}});
    scene.materials.push_back({mirror, {}});
    scene.objects.push_back({"scene", {}, {}});
    return scene;
}

Vec3 random_point(RandomStream& random) {
    const double x = random.uniform(), y = random.uniform(), z = random.uniform();
    return {x, y, z};
}

Vec3 random_direction(RandomStream& random) {
    for (;;) {
        const Vec3 p = 2.0 * random_point(random) - Vec3{1, 1, 1};
        const double squared = length_squared(p);
        if (squared > 0.01 && squared <= 1.0) return p / std::sqrt(squared);
    }
}

AnyShape random_shape(ClaimShape shape, double size, RandomStream& random) {
    const Vec3 center = random_point(random);
    const Vec3 along = random_direction(random);
    switch (shape) {
        case ClaimShape::Spheres:
            break;
        case ClaimShape::Boxes: {
            const Vec3 half = 0.7 * size * Vec3{1, 1, 1};
            return BoxShape{center - half, center + half};
        }
        case ClaimShape::Cylinders:
            return Cylinder{
                .base = center - size * along, .top = center + size * along, .radius = 0.6 * size};
        case ClaimShape::ThinSticks:
            return Cylinder{
                .base = center - 0.2 * along, .top = center + 0.2 * along, .radius = 0.02 * size};
    }
    return Sphere{center, size};
}

}  // namespace

SceneDescription claim_scene(ClaimShape shape, std::uint64_t count, double spread) {
    SceneDescription scene = empty_scene();
    RandomStream random(7);
    const double size = spread * 0.3 / std::cbrt(static_cast<double>(count));
    for (std::uint64_t i = 0; i < count; ++i) {
        Part part;
        part.what = random_shape(shape, size, random);
        part.material = MaterialId{i % 4 == 0 ? 1u : 0u};
        scene.objects.front().parts.push_back(std::move(part));
    }
    return scene;
}

}  // namespace alhazen
