#include "alhazen/illumination/light_chooser.h"

#include <algorithm>
#include <cmath>

namespace alhazen {

LightChooser::LightChooser(const std::vector<double>& weights) {
    sums_.reserve(weights.size());
    double sum = 0.0;
    for (const double w : weights) {
        if (w > 0.0 && std::isfinite(w)) sum += w;
        sums_.push_back(sum);
    }
}

ChosenLight LightChooser::choose(double choice) const {
    if (!(total() > 0.0)) return {};
    auto found = std::upper_bound(sums_.begin(), sums_.end(), choice * total());
    // The product may round up to the total.
    if (found == sums_.end()) found = std::lower_bound(sums_.begin(), sums_.end(), total());
    const std::size_t light = std::size_t(found - sums_.begin());
    return {light, probability(light)};
}

double LightChooser::probability(std::size_t light) const {
    const double before = light == 0 ? 0.0 : sums_[light - 1];
    return total() > 0.0 ? (sums_[light] - before) / total() : 0.0;
}

}  // namespace alhazen
