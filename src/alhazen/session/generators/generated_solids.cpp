#include "alhazen/session/generators/generated_solids.h"

#include <cmath>
#include <utility>

#include "alhazen/session/generators/generated_scene.h"

namespace alhazen {

namespace {

SceneDescription begin_scene(const Vec3& eye, const Vec3& target) {
    SceneDescription scene = generated_scene({eye, target, 40.0});
    add_material(scene, "skin", {0.7, 0.7, 0.75});
    add_material(scene, "cut", {0.8, 0.45, 0.2});
    return scene;
}

constexpr MaterialId kSkin{0}, kCut{1};

void place(SceneDescription& scene, ObjectDescription solid) {
    solid.combine = Combine::Difference;
    Part part;
    part.what = ObjectIndex{static_cast<std::uint32_t>(scene.objects.size())};
    scene.objects.push_back(std::move(solid));
    scene.objects.front().parts.push_back(std::move(part));
}

/// The least whole number whose `power`-th power is at least `n`.
std::uint64_t side_of_grid(std::uint64_t n, int power) {
    auto side = static_cast<std::uint64_t>(std::pow(static_cast<double>(n), 1.0 / power));
    const auto fits = [&] {
        std::uint64_t product = 1;
        for (int i = 0; i < power; ++i) product *= side;
        return product >= n;
    };
    while (!fits()) ++side;
    return side;
}

}  // namespace

SceneDescription perforated_plate(std::uint64_t holes) {
    SceneDescription scene = begin_scene({1.2, -2.6, 2.2}, {0, 0, 0});
    ObjectDescription plate{"plate", {}, {}};
    plate.parts.reserve(holes + 1);
    plate.parts.push_back(part_of(BoxShape{{-1, -1, -0.05}, {1, 1, 0.05}}, kSkin));
    const std::uint64_t side = side_of_grid(holes, 2);
    const double pitch = 2.0 / static_cast<double>(side);
    for (std::uint64_t i = 0; i < holes; ++i) {
        const double x = -1.0 + pitch * (static_cast<double>(i % side) + 0.5);
        const double y = -1.0 + pitch * (static_cast<double>(i / side) + 0.5);
        plate.parts.push_back(part_of(
            Cylinder{.base = {x, y, -0.06}, .top = {x, y, 0.06}, .radius = 0.3 * pitch}, kCut));
    }
    place(scene, std::move(plate));
    return scene;
}

SceneDescription menger_sponge(std::uint64_t leaves) {
    SceneDescription scene = begin_scene({2.1, -1.6, 1.7}, {0.5, 0.5, 0.45});
    ObjectDescription sponge{"sponge", {}, {}};
    sponge.parts.push_back(part_of(BoxShape{{0, 0, 0}, {1, 1, 1}}, kSkin));
    // A carpet of side^2 cells has a hole where no pair of digits in base 3 is (1, 1).
    const auto is_there = [](std::uint64_t i, std::uint64_t j) {
        for (; i > 0 && j > 0; i /= 3, j /= 3) {
            if (i % 3 == 1 && j % 3 == 1) return false;
        }
        return true;
    };
    for (std::uint64_t side = 1; sponge.parts.size() < leaves; side *= 3) {
        const double cell = 1.0 / static_cast<double>(3 * side);
        for (std::uint64_t n = 0; n < side * side; ++n) {
            const std::uint64_t i = n % side, j = n / side;
            if (!is_there(i, j)) continue;
            for (int axis = 0; axis < 3; ++axis) {
                BoxShape bar{{-0.01, -0.01, -0.01}, {1.01, 1.01, 1.01}};
                const int u = (axis + 1) % 3, v = (axis + 2) % 3;
                bar.lo[u] = static_cast<double>(3 * i + 1) * cell;
                bar.hi[u] = static_cast<double>(3 * i + 2) * cell;
                bar.lo[v] = static_cast<double>(3 * j + 1) * cell;
                bar.hi[v] = static_cast<double>(3 * j + 2) * cell;
                sponge.parts.push_back(part_of(bar, kCut));
            }
        }
    }
    place(scene, std::move(sponge));
    return scene;
}

SceneDescription drilled_spheres(std::uint64_t spheres) {
    SceneDescription scene = begin_scene({2.3, -2.8, 2.0}, {0, 0, 0});
    const std::uint64_t side = side_of_grid(spheres, 3);
    const double pitch = 2.0 / static_cast<double>(side);
    for (std::uint64_t n = 0; n < spheres; ++n) {
        const Vec3 center{-1.0 + pitch * (static_cast<double>(n % side) + 0.5),
                          -1.0 + pitch * (static_cast<double>(n / side % side) + 0.5),
                          -1.0 + pitch * (static_cast<double>(n / side / side) + 0.5)};
        Vec3 along{};  // the holes run along the three axes in turn
        along[static_cast<int>(n % 3)] = 0.5 * pitch;
        ObjectDescription drilled{"drilled", {}, {}};
        drilled.parts.push_back(part_of(Sphere{center, 0.42 * pitch}, kSkin));
        drilled.parts.push_back(part_of(
            Cylinder{.base = center - along, .top = center + along, .radius = 0.2 * pitch}, kCut));
        place(scene, std::move(drilled));
    }
    return scene;
}

}  // namespace alhazen
