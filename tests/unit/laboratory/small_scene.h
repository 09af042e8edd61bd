#pragma once
/// A scene with rays of all four kinds: mirrors and glass above a floor, with a light.

#include "alhazen/sampling/random.h"
#include "support/scene_maker.h"

namespace alhazen::testing {

/// `spheres` spheres and three more primitives.
inline SceneDescription small_scene(int spheres = 40) {
    SceneMaker scene;
    Material plain, mirror, glass;
    plain.diffuse.color = {0.7, 0.6, 0.5};
    mirror.diffuse.color = {0.2, 0.2, 0.2};
    mirror.reflective.color = {0.7, 0.7, 0.7};
    glass.transmissive.color = {0.8, 0.8, 0.8};
    glass.index.value = 1.4;
    const MaterialId materials[] = {scene.material(plain), scene.material(mirror),
                                    scene.material(glass)};
    scene.light(PointLight{.position = {3, 5, 4}, .color = {1, 1, 1}});
    RandomStream random(5);
    for (int i = 0; i < spheres; ++i) {
        const Vec3 center{random.uniform(-1.5, 1.5), random.uniform(-1.5, 1.5),
                          random.uniform(-2, 1)};
        scene.add(Sphere{center, random.uniform(0.1, 0.35)}, materials[i % 3]);
    }
    // Long primitives in many cells: a ray may test them long before it reaches the hit.
    scene.add(Sphere{{0, 0, -2.5}, 1.6}, materials[0]);
    scene.add(Cylinder{.base = {-1.8, -1.5, -2}, .top = {1.8, 1.5, 1}, .radius = 0.3},
              materials[1]);
    scene.add(Cylinder{.base = {1.8, -1.2, -2}, .top = {-1.8, 1.2, 1}, .radius = 0.3},
              materials[0]);
    scene.description().picture.width = 40;
    scene.description().picture.height = 30;
    return scene.description();
}

}  // namespace alhazen::testing
