#pragma once
/// Photons as points in space, for looking at them.

#include <array>
#include <cstdint>
#include <vector>

namespace alhazen {

struct CloudPhoton {
    std::array<float, 3> position{};
    std::array<float, 3> direction{};  ///< unit, in which it travelled
    std::array<float, 3> power{};
    std::uint8_t caustic = 0;  ///< 1: of the map of caustics
};

struct PhotonCloud {
    std::vector<CloudPhoton> photons;
};

}  // namespace alhazen
