#pragma once
/// Projections of cameras by name, as users write them: "NAME" or "NAME:DEGREES".

#include <string>
#include <string_view>

#include "alhazen/base/error.h"
#include "alhazen/cameras/camera.h"

namespace alhazen {

/// "fisheye", "equisolid", "panorama" or "perspective", and the angle of the picture's height in
/// degrees (180, 180, 180, 45).
struct Projection {
    std::string name;
    double fov_deg = 0;
};

/// Throws Error (Usage) listing the names for an unknown one, and the limits for an angle.
[[nodiscard]] Projection parse_projection(const std::string& text);

/// A camera at the same place that looks the same way. A panorama is twice as wide as high, the
/// others have the aspect ratio `aspect`, which becomes that of the result.
[[nodiscard]] Camera with_projection(const Camera& camera, const Projection& projection,
                                     double& aspect);

/// What they say who know flat pictures only.
[[nodiscard]] inline Error flat_pictures_only(std::string_view who) {
    return Error(ErrorKind::Usage, std::string(who) +
                                       " draw flat pictures: they have no fisheyes and no "
                                       "panoramas");
}

}  // namespace alhazen
