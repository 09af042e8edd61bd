#pragma once
/// Constants of angles. Files and the command line use degrees, all else radians.

#include <limits>
#include <numbers>

namespace alhazen {

inline constexpr double kPi = std::numbers::pi;
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
inline constexpr double kRadiansPerDegree = kPi / 180.0;

}  // namespace alhazen
