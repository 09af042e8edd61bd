#include "view_menus.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "alhazen/aggregates/accelerator_table.h"
#include "alhazen/cameras/eye_rays.h"
#include "alhazen/imaging/figures/false_color.h"
#include "alhazen/imaging/image/tone_mapping.h"
#include "alhazen/laboratory/traversal_trace.h"
#include "alhazen/renderers/core/renderer.h"
#include "alhazen/renderers/light_transport/path_settings.h"
#include "alhazen/session/environment_option.h"
#include "alhazen/session/lighting.h"
#include "alhazen/session/render.h"

namespace alhazen::viewer {

namespace {

using json = nlohmann::ordered_json;

/// The distance of the surface in the middle, around which the view turns; 0 without a surface.
double distance_in_middle(const Scene& scene, const Camera& camera) {
    const Ray ray = eye_ray(camera, 0.5, 0.5);
    Hit hit;
    const bool found = scene.aggregate->closest(ray, hit, {nullptr, mask_of(RayKind::Eye)});
    return found && std::isfinite(hit.t) ? hit.t : 0.0;
}

json list_of(const Vec3& v) {
    return {v.x, v.y, v.z};
}

json camera_json(const Scene& scene, const CameraDescription& described) {
    const PicturePlane plane = picture_plane(described.camera);
    return {{"name", described.name},
            {"eye", list_of(plane.eye)},
            {"look", list_of(plane.forward)},
            {"right", list_of(plane.right)},
            {"up", list_of(plane.up)},
            {"aspect", described.aspect},
            {"parallel", std::holds_alternative<OrthographicCamera>(described.camera)},
            {"distance", distance_in_middle(scene, described.camera)}};
}

/// The renderers that need no other geometry than is loaded. `depth`: the default, unless it is
/// that of the scene; counted as in `with_depth`.
json renderer_menu() {
    json menu = json::array();
    for (const RendererEntry& entry : renderers()) {
        const std::unique_ptr<Renderer> renderer = make_renderer(entry.name);
        if (renderer->takes_triangles_within() > 0.0) continue;
        json choice{{"name", entry.name},
                    {"what", entry.description},
                    {"selects", renderer->answers_single_rays()},
                    {"follows_light", renderer->follows_light()}};
        if (entry.follows_paths) choice["depth"] = PathSettings{}.depth - 1;
        menu.push_back(std::move(choice));
    }
    return menu;
}

/// The colours of a scale, from its low end.
json scale_json(ColorScale::Colors colors) {
    constexpr int kSteps = 24;
    json list = json::array();
    for (int i = 0; i <= kSteps; ++i) {
        const Rgb c = scale_color(colors, static_cast<double>(i) / kSteps);
        const auto code = [](double x) { return std::lround(255.0 * std::clamp(x, 0.0, 1.0)); };
        list.push_back(fmt::format("rgb({} {} {})", code(c.r), code(c.g), code(c.b)));
    }
    return list;
}

template <class Table>
json menu_of(const Table& table) {
    json menu = json::array();
    for (const auto& entry : table) {
        menu.push_back({{"name", entry.name}, {"what", entry.description}});
    }
    return menu;
}

}  // namespace

json view_menus(const LoadedScene& loaded) {
    json lights = json::array();
    for (const NamedLight& light : light_choices(loaded.description)) {
        json entry{{"name", light.name},
                   {"what", light.kind},
                   {"color", {light.color.r, light.color.g, light.color.b}}};
        if (light.position) entry["position"] = list_of(*light.position);
        if (light.direction) entry["direction"] = list_of(*light.direction);
        for (const ExtentSize& size : light.sizes) {
            entry["sizes"].push_back({{"name", size.name}, {"value", size.value}});
        }
        lights.push_back(std::move(entry));
    }
    static const json kRenderers = renderer_menu();
    const Scene& scene = loaded.scene;
    const FrameSize frame =
        frame_size(loaded.description.picture, {}, scene.cameras.front().aspect);
    json cameras = json::array();
    for (const CameraDescription& camera : scene.cameras) {
        cameras.push_back(camera_json(scene, camera));
    }
    return {{"scene", loaded.description.path.filename().string()},
            {"width", frame.width},
            {"height", frame.height},
            {"up", loaded.description.up_axis == UpAxis::Z ? "z" : "y"},
            {"depth", scene.conventions.shading.max_depth},
            {"cameras", std::move(cameras)},
            {"renderers", kRenderers},
            {"accelerators", menu_of(accelerator_table())},
            {"lights", std::move(lights)},
            {"environments", menu_of(environments())},
            {"layers", menu_of(aov_table())},
            {"scales",
             {{"heat", scale_json(ColorScale::Colors::Heat)},
              {"grey", scale_json(ColorScale::Colors::NearGrey)}}},
            {"curves", kToneCurveNames},
            {"steps", traceable_accelerators()}};
}

}  // namespace alhazen::viewer
