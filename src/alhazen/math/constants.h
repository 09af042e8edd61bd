#pragma once
/// Constants. Files and the command line use degrees, everything else radians.

#include <limits>
#include <numbers>

namespace alhazen {

inline constexpr double kPi = std::numbers::pi;
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
inline constexpr double kRadiansPerDegree = kPi / 180.0;

}  // namespace alhazen
