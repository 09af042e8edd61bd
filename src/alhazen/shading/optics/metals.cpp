#include "alhazen/shading/optics/metals.h"

#include <algorithm>

namespace alhazen {

namespace {

constexpr Metal kMetals[] = {
    {"aluminium", {1.322, 1.011, 0.684}, {7.311, 6.617, 5.627}},
    {"chromium", {3.178, 3.180, 2.450}, {3.300, 3.330, 3.207}},
    {"copper", {0.362, 1.015, 1.247}, {3.127, 2.579, 2.453}},
    {"gold", {0.222, 0.428, 1.334}, {3.208, 2.461, 1.872}},
    {"iron", {2.890, 2.950, 2.643}, {3.040, 2.930, 2.803}},
    {"nickel", {1.985, 1.920, 1.763}, {3.985, 3.611, 3.043}},
    {"silver", {0.058, 0.060, 0.047}, {4.106, 3.590, 2.796}},
    {"titanium", {2.659, 2.540, 2.303}, {3.698, 3.430, 3.080}},
};

}  // namespace

std::span<const Metal> metals() {
    return kMetals;
}

const Metal* find_metal(std::string_view name) {
    const auto* found = std::ranges::find(kMetals, name, &Metal::name);
    return found == std::end(kMetals) ? nullptr : found;
}

}  // namespace alhazen
