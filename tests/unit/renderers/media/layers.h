#pragma once
/// Light along the normal of a stack of layers, in closed form.

#include <cmath>
#include <vector>

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

}  // namespace alhazen::testing
