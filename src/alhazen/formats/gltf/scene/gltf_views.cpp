#include "alhazen/formats/gltf/scene/gltf_views.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "alhazen/math/unit_vector.h"

namespace alhazen::gltf {

namespace {

std::string name_of(const std::string& node, const std::string& thing, const char* kind,
                    std::size_t position) {
    if (!node.empty()) return node;
    return thing.empty() ? fmt::format("{} {}", kind, position) : thing;
}

CameraDescription camera_of(const Camera& camera, const Affine& world_from_node) {
    const Vec3& eye = world_from_node.translation;
    const Vec3 look = unit_or(-world_from_node.linear.z_axis, {0, 0, -1});
    Vec3 up = unit_or(world_from_node.linear.y_axis, {0, 1, 0});
    // Scales of zero may leave an up vector parallel to the view direction.
    if (length(cross(look, up)) < 1e-9) up = perpendicular(look);
    CameraDescription result;
    if (camera.perspective) {
        result.aspect = camera.aspect.value_or(1.0);
        result.camera = look_along(eye, look, up, camera.yfov, result.aspect);
    } else {
        const double width = 2.0 * std::abs(camera.xmag), height = 2.0 * std::abs(camera.ymag);
        result.aspect = width / height;
        result.camera = look_along_parallel(eye, look, up, height, result.aspect);
    }
    return result;
}

Light light_of(const PunctualLight& light, const Affine& world_from_node) {
    const Rgb color =
        (light.intensity / std::numbers::pi) * Rgb{light.color[0], light.color[1], light.color[2]};
    const Vec3 direction = unit_or(-world_from_node.linear.z_axis, {0, 0, -1});
    const Attenuation inverse_square{0, 0, 1};
    const double range = light.range.value_or(std::numeric_limits<double>::infinity());
    switch (light.type) {
        case PunctualLight::Type::Directional: {
            DirectionalLight result;
            result.to_light = -direction;
            result.color = color;
            return result;
        }
        case PunctualLight::Type::Spot: {
            SpotLight result;
            result.position = world_from_node.translation;
            result.direction = direction;
            result.inner_angle = light.inner_cone;
            result.outer_angle = light.outer_cone;
            result.color = color;
            result.attenuation = inverse_square;
            result.range = range;
            return result;
        }
        case PunctualLight::Type::Point:
            break;
    }
    PointLight result;
    result.position = world_from_node.translation;
    result.color = color;
    result.attenuation = inverse_square;
    result.range = range;
    return result;
}

}  // namespace

void add_cameras(const Document& document, std::span<const Index> nodes,
                 const std::vector<Affine>& world_from_node, SceneDescription& scene) {
    for (const Index index : nodes) {
        const Node& node = document.nodes[index];
        if (!node.camera) continue;
        const Camera& camera = document.cameras[*node.camera];
        CameraDescription result = camera_of(camera, world_from_node[index]);
        result.name = name_of(node.name, camera.name, "camera", scene.cameras.size());
        result.location = {scene.path.string(), 0, 0};
        scene.cameras.push_back(std::move(result));
    }
}

void add_lights(const Document& document, std::span<const Index> nodes,
                const std::vector<Affine>& world_from_node, SceneDescription& scene) {
    for (const Index index : nodes) {
        const Node& node = document.nodes[index];
        if (!node.light) continue;
        const PunctualLight& light = document.lights[*node.light];
        scene.lights.push_back({name_of(node.name, light.name, "light", scene.lights.size()),
                                light_of(light, world_from_node[index]),
                                {scene.path.string(), 0, 0}});
    }
}

}  // namespace alhazen::gltf
