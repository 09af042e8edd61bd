#pragma once
/// Rooms of white, red and green walls with lights, for tests of photon maps and vertex merging.

#include <functional>
#include <vector>

#include "support/light_pictures.h"

namespace alhazen::testing {

struct NamedRoom {
    const char* name;
    Scene scene;
};

/// The camera and the walls of a room of 2 x 2 x 2, open to the eye, but the green one on the
/// right.
inline void add_walls(SceneMaker& maker, const Rgb& white) {
    const MaterialId plain = maker.material(matt(white));
    maker.description().cameras[0].camera =
        look_along({0, -3.8, 1}, {0, 1, 0}, {0, 0, 1}, 0.65, 1.0);
    maker.add(rectangle({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}), plain);
    maker.add(rectangle({-1, -1, 2}, {0, 2, 0}, {2, 0, 0}), plain);
    maker.add(rectangle({-1, 1, 0}, {2, 0, 0}, {0, 0, 2}), plain);
    maker.add(rectangle({-1, -1, 0}, {0, 2, 0}, {0, 0, 2}), maker.material(matt({0.6, 0.1, 0.1})));
}
inline void add_room(SceneMaker& maker, const Rgb& white) {
    add_walls(maker, white);
    maker.add(rectangle({1, -1, 0}, {0, 0, 2}, {0, 2, 0}), maker.material(matt({0.1, 0.5, 0.1})));
}

/// A room with what `fill` adds.
inline Scene room(const std::function<void(SceneMaker&)>& fill) {
    SceneMaker maker;
    add_room(maker, {0.7, 0.7, 0.7});
    fill(maker);
    return maker.compile("wide_bvh");
}

/// A square of light under the ceiling, which shines downward.
inline void add_lamp(SceneMaker& maker, double half, const Rgb& radiance) {
    Material lamp = shining(radiance);
    lamp.double_sided = false;
    maker.add(rectangle({-half, -half, 1.98}, {0, 2 * half, 0}, {2 * half, 0, 0}),
              maker.material(lamp));
}

inline Scene room_of_glass() {
    return room([](SceneMaker& m) {
        add_lamp(m, 0.5, {4, 4, 4});
        m.add(ball({0.2, 0, 0.5}, 0.4), m.material(smooth_glass()));
    });
}

/// A lamp, a point, a glossy floor, a ball of glass, sun and sky.
inline std::vector<NamedRoom> plain_rooms() {
    std::vector<NamedRoom> all;
    all.push_back({"lamp and ball", room([](SceneMaker& m) {
                       add_lamp(m, 0.3, {9, 8, 6});
                       m.add(ball({0.3, 0, 0.4}, 0.4), m.material(matt({0.8, 0.8, 0.2})));
                   })});
    all.push_back({"point light", room([](SceneMaker& m) {
                       m.light(PointLight{.position = {0.3, -0.2, 1.5},
                                          .color = {1, 1, 2},
                                          .attenuation = {0, 0, 1}});
                   })});
    all.push_back(
        {"glossy floor", room([](SceneMaker& m) {
             add_lamp(m, 0.4, {6, 6, 6});
             Material glossy;
             glossy.metallic_roughness.emplace();
             glossy.metallic_roughness->base_color.color = {0.8, 0.7, 0.6};
             glossy.metallic_roughness->metallic.value = 0.5;
             glossy.metallic_roughness->roughness.value = 0.35;
             m.add(rectangle({-0.9, -0.9, 0.1}, {1.8, 0, 0}, {0, 1.8, 0}), m.material(glossy));
         })});
    all.push_back({"glass ball", room_of_glass()});
    all.push_back({"sun and sky", room([](SceneMaker& m) {
                       m.description().picture.background = Rgb{0.5, 0.6, 0.9};
                       m.light(DirectionalLight{.to_light = normalize(Vec3{0.2, -1, 0.8}),
                                                .color = {1, 1, 0.5}});
                   })});
    return all;
}

}  // namespace alhazen::testing
