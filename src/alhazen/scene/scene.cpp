#include "alhazen/scene/scene.h"

#include <fmt/format.h>

#include <charconv>

#include "alhazen/base/control_characters.h"
#include "alhazen/base/error.h"

namespace alhazen {

const CameraDescription& find_camera(const Scene& scene, const std::string& name) {
    if (scene.cameras.empty()) throw Error(ErrorKind::Scene, "the scene has no camera");
    if (name.empty()) return scene.cameras.front();
    for (const CameraDescription& camera : scene.cameras) {
        if (camera.name == name) return camera;
    }
    std::size_t index = 0;
    const auto [end, status] = std::from_chars(name.data(), name.data() + name.size(), index);
    if (status == std::errc{} && end == name.data() + name.size() && index < scene.cameras.size()) {
        return scene.cameras[index];
    }
    std::string known;
    for (std::size_t i = 0; i < scene.cameras.size(); ++i) {
        known +=
            fmt::format("{}{} '{}'", i == 0 ? "" : ", ", i, escape_controls(scene.cameras[i].name));
    }
    throw Error(ErrorKind::Usage, fmt::format("no camera '{}'; the scene has: {}", name, known));
}

}  // namespace alhazen
