#pragma once
/// The surroundings of a scene at infinite distance, as described by a file or a user; the input of
/// `Environment` (environment.h).
///
/// Conventions: `up` and `to_sun` are in world space and of any length but 0; `rotation` turns
/// picture, sky and studio about `up`, anticlockwise from above.

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "alhazen/imaging/image/rgb.h"
#include "alhazen/math/vec.h"

namespace alhazen {

struct Image;

enum class EnvironmentKind : std::uint8_t {
    Constant,  ///< `color` in all directions
    Picture,   ///< all directions, latitude by longitude
    Sky,       ///< clear, with a sun
    Studio,    ///< lights with soft boxes in front of grey walls
};
/// [kind] the names in files and on the command line.
inline constexpr const char* kEnvironmentKindNames[] = {"constant", "picture", "sky", "studio"};

/// Range of the turbidity of a sky.
inline constexpr double kLeastTurbidity = 1.0, kLargestTurbidity = 10.0;

struct EnvironmentSettings {
    EnvironmentKind kind = EnvironmentKind::Constant;
    Rgb color{1, 1, 1};  ///< radiance; a factor for other kinds than Constant
    std::string file;    ///< name of the picture, as in the scene
    /// The picture, already read. If it is not linear, it is decoded from sRGB.
    std::shared_ptr<const Image> picture;
    double scale = 1;        ///< a further factor, at least 0
    double rotation = 0;     ///< radians
    std::optional<Vec3> up;  ///< default: the up axis of the scene
    double turbidity = 3;    ///< of a sky: kLeastTurbidity (pure air) to kLargestTurbidity (haze)
    /// Sky: direction of the sun before `rotation`; default: 40 degrees high, over the right
    /// shoulder of a viewer who faces the front.
    std::optional<Vec3> to_sun;
    Rgb ground{0.2, 0.2, 0.2};  ///< albedo of the ground below a sky, 0..1
};

}  // namespace alhazen
