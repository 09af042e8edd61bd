#pragma once
/// Light along the normal of a stack of layers, in closed form, and scenes of such stacks.

#include <cmath>
#include <vector>

#include "support/scene_maker.h"
#include "unit/renderers/one_pixel.h"

namespace alhazen::testing {

struct Layer {
    double index, absorption = 0, thickness = 0;
};

/// The share of the light that passes all layers, with the geometric series of the reflections
/// between them; the first and the last layer are the surroundings.
inline double passed(const std::vector<Layer>& layers) {
    double through = 1.0, back = 0.0;  // of the layers so far; `back`: seen from behind
    for (std::size_t i = 1; i < layers.size(); ++i) {
        const double m = layers[i - 1].index, n = layers[i].index;
        const double r = std::pow((m - n) / (m + n), 2.0);
        const double orders = 1.0 / (1.0 - back * r);
        through *= (1.0 - r) * orders;
        back = r + (1.0 - r) * (1.0 - r) * back * orders;
        const double left = std::exp(-layers[i].absorption * layers[i].thickness);
        through *= left;
        back *= left * left;
    }
    return through;
}

/// A physical dielectric with the medium of the layer.
inline Material physical(const Layer& layer) {
    Material m;
    m.index.value = layer.index;
    m.dielectric = Dielectric{{layer.absorption, layer.absorption, layer.absorption}};
    return m;
}

inline BoxShape box(double bottom, double top, double half = 3.0) {
    return {{-half, -half, bottom}, {half, half, top}};
}

/// Black surroundings, seen from above the origin, and a light below.
inline SceneMaker above_a_light() {
    SceneMaker maker;
    ShadingConventions& c = maker.description().conventions.shading;
    c.optics = {true, true};
    c.max_depth = 16;
    maker.description().cameras[0].camera =
        look_along({0.1, 0.2, 30}, {0, 0, -1}, {0, 1, 0}, 1e-9, 1.0);
    maker.add(Rectangle{{-50, -50, -20}, {100, 0, 0}, {0, 100, 0}},
              maker.material(glowing({1, 1, 1})));
    return maker;
}

/// Expects the closed form in the picture of one pixel.
inline void expect_light_passed(SceneMaker& maker, const std::vector<Layer>& layers,
                                double within = 1e-9) {
    const double t = passed(layers);
    expect_near(center(maker.compile()), {t, t, t}, within);
}

}  // namespace alhazen::testing
