#pragma once
/// Projections of cameras by name, in the form "NAME" or "NAME:DEGREES".

#include <string>
#include <string_view>

#include "alhazen/base/error.h"
#include "alhazen/cameras/camera.h"

namespace alhazen {

/// A name ("fisheye", "equisolid", "panorama" or "perspective") and the angle of the picture's
/// height in degrees (by default 180, 180, 180, 45).
struct Projection {
    std::string name;
    double fov_deg = 0;
};

/// Throws Error (Usage) for an unknown name, listing the names, and for an angle out of its limits.
[[nodiscard]] Projection parse_projection(const std::string& text);

/// A camera with the same place and direction of view, in another projection. A panorama is twice
/// as wide as high; other projections keep the aspect ratio `aspect`. Sets `aspect` to that of the
/// result.
[[nodiscard]] Camera with_projection(const Camera& camera, const Projection& projection,
                                     double& aspect);

/// The error of renderers that do not support wide cameras.
[[nodiscard]] inline Error flat_pictures_only(std::string_view who) {
    return Error(ErrorKind::Usage,
                 std::string(who) + " do not support fisheye and panorama cameras");
}

}  // namespace alhazen
