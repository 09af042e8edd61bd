#include "alhazen/session/generators/city.h"

#include <algorithm>
#include <cmath>

#include "alhazen/sampling/random.h"
#include "alhazen/session/generators/generated_scene.h"

namespace alhazen {

SceneDescription city(std::uint64_t houses) {
    const double side = std::ceil(std::sqrt(static_cast<double>(houses)));
    SceneDescription scene = generated_scene(
        {{-0.35 * side, -0.5 * side, 0.42 * side}, {0.5 * side, 0.5 * side, 0}, 42.0});
    const MaterialId ground = add_material(scene, "ground", {0.35, 0.4, 0.33});
    const MaterialId walls[] = {add_material(scene, "stone", {0.7, 0.68, 0.62}),
                                add_material(scene, "brick", {0.65, 0.4, 0.3}),
                                add_material(scene, "slate", {0.45, 0.5, 0.6}),
                                add_material(scene, "glass", {0.25, 0.3, 0.35})};
    scene.materials.back().material.reflective.color = {0.2, 0.2, 0.2};
    std::vector<Part>& parts = scene.objects.front().parts;
    parts.reserve(houses + 1);
    Rectangle floor;
    floor.corner = {-2, -2, 0};
    floor.edge_u = {side + 4, 0, 0};
    floor.edge_v = {0, side + 4, 0};
    parts.push_back(part_of(floor, ground));
    const auto per_row = static_cast<std::uint64_t>(side);
    for (std::uint64_t n = 0; n < houses; ++n) {
        // Independent random numbers for each house.
        const auto number = [&](std::uint64_t k) {
            return static_cast<double>(mix64(mix64(n + 1) ^ k) >> 11) * 0x1p-53;
        };
        const double half = 0.3 + 0.12 * number(1);
        const double height = 0.3 - 1.4 * std::log(1.0 - number(2));
        const double x = static_cast<double>(n % per_row) + 0.5;
        const double y = static_cast<double>(n / per_row) + 0.5;
        parts.push_back(
            part_of(BoxShape{{x - half, y - half, 0}, {x + half, y + half, std::min(height, 8.0)}},
                    walls[n % 4]));
    }
    return scene;
}

}  // namespace alhazen
