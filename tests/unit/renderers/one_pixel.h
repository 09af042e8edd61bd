#pragma once
/// Pictures of one pixel, and their colour.

#include <gtest/gtest.h>

#include "alhazen/renderers/whitted/whitted.h"
#include "support/expect_near.h"
#include "support/scene_maker.h"

namespace alhazen::testing {

/// Colour of the middle of the picture; the camera of SceneMaker looks along -z from (0, 0, 5).
inline Rgb center(const Scene& scene, RayCounters& counters,
                  const TiledRenderer& renderer = Whitted{}) {
    Film film(1, 1, {0, 0, 1, 1});
    const RenderJob job{.scene = scene, .camera = scene.cameras[0].camera};
    renderer.render_tile(job, {0, 0, 1, 1}, film, counters);
    return film.at(0, 0);
}
inline Rgb center(const Scene& scene, const TiledRenderer& renderer = Whitted{}) {
    RayCounters counters;
    return center(scene, counters, renderer);
}

inline Material glowing(const Rgb& color) {
    Material m;
    m.emission.color = color;
    return m;
}

}  // namespace alhazen::testing
