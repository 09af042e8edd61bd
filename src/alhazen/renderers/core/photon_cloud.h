#pragma once
/// Photons as points in space, for display.

#include <array>
#include <cstdint>
#include <vector>

namespace alhazen {

struct CloudPhoton {
    std::array<double, 3> position{};
    std::array<float, 3> direction{};  ///< unit, of travel
    std::array<float, 3> power{};
    std::uint8_t caustic = 0;  ///< 1: from the caustic map
};

struct PhotonCloud {
    std::vector<CloudPhoton> photons;
};

}  // namespace alhazen
