#include "alhazen/cameras/projection.h"

#include <array>
#include <charconv>
#include <numbers>

namespace alhazen {

namespace {

struct Named {
    const char* name;
    double usual, most;  ///< default and largest angle, in degrees
    bool excludes_most;
};
constexpr std::array<Named, 4> kProjections{{{"fisheye", 180, 360, false},
                                             {"equisolid", 180, 360, false},
                                             {"panorama", 180, 180, false},
                                             {"perspective", 45, 180, true}}};

[[noreturn]] void refuse_projection(const std::string& text, const std::string& expected) {
    throw Error(ErrorKind::Usage, "projection '" + text + "': expected " + expected);
}

}  // namespace

Projection parse_projection(const std::string& text) {
    const std::string name = text.substr(0, text.find(':'));
    std::string known;
    for (const Named& p : kProjections) {
        known += (known.empty() ? "" : ", ") + std::string(p.name);
        if (name != p.name) continue;
        Projection projection{name, p.usual};
        if (name.size() == text.size()) return projection;
        const char* const begin = text.data() + name.size() + 1;
        const char* const end = text.data() + text.size();
        const auto [read, failed] = std::from_chars(begin, end, projection.fov_deg);
        const double fov = projection.fov_deg;
        if (failed != std::errc{} || read != end || !(fov > 0.0 && fov <= p.most) ||
            (p.excludes_most && fov == p.most)) {
            refuse_projection(text, "degrees above 0 and " +
                                        std::string(p.excludes_most ? "below " : "at most ") +
                                        std::to_string(static_cast<int>(p.most)));
        }
        return projection;
    }
    refuse_projection(text, "one of " + known + ", or NAME:DEGREES");
}

Camera with_projection(const Camera& camera, const Projection& projection, double& aspect) {
    const PicturePlane plane = picture_plane(camera);
    const double fov = projection.fov_deg * std::numbers::pi / 180.0;
    if (projection.name == "perspective") {
        return look_along(plane.eye, plane.forward, plane.up, fov, aspect);
    }
    if (projection.name == "panorama") {
        aspect = 2.0;
        return look_around(plane.eye, plane.forward, plane.up, WideProjection::Panorama, fov,
                           aspect);
    }
    return look_around(
        plane.eye, plane.forward, plane.up,
        projection.name == "fisheye" ? WideProjection::Equidistant : WideProjection::Equisolid, fov,
        aspect);
}

}  // namespace alhazen
