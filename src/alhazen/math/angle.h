#pragma once
/// Pi, and degrees in radians: files and the command line speak of degrees, all else of radians.

#include <numbers>

namespace alhazen {

inline constexpr double kPi = std::numbers::pi;
inline constexpr double kRadiansPerDegree = kPi / 180.0;

}  // namespace alhazen
