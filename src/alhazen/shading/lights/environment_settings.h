#pragma once
/// What surrounds a scene at an infinite distance, as a file or a user describes it. `Environment`
/// (environment.h) is made of it.
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
    Constant,  ///< `color` from everywhere
    Picture,   ///< of all directions, latitude by longitude
    Sky,       ///< clear, with a sun
    Studio,    ///< lamps with soft boxes before grey walls
};
/// [kind] as files and the command line call them.
inline constexpr const char* kEnvironmentKindNames[] = {"constant", "picture", "sky", "studio"};

/// Of the clear sky.
inline constexpr double kLeastTurbidity = 1.0, kLargestTurbidity = 10.0;

struct EnvironmentSettings {
    EnvironmentKind kind = EnvironmentKind::Constant;
    Rgb color{1, 1, 1};  ///< radiance; of other kinds a factor
    std::string file;    ///< of a picture, as named
    /// Already read. Not linear: it is decoded from sRGB.
    std::shared_ptr<const Image> picture;
    double scale = 1;        ///< a further factor, at least 0
    double rotation = 0;     ///< radians
    std::optional<Vec3> up;  ///< default: the up axis of the scene
    double turbidity = 3;    ///< of a sky: kLeastTurbidity (pure air) to kLargestTurbidity (haze)
    /// Of a sky, before `rotation`; default: 40 degrees high, over the right shoulder of who looks
    /// to the front.
    std::optional<Vec3> to_sun;
    Rgb ground{0.2, 0.2, 0.2};  ///< of a sky: albedo, 0..1
};

}  // namespace alhazen
