#include "view_menus.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "alhazen/aggregates/accelerator_table.h"
#include "alhazen/base/error.h"
#include "alhazen/cameras/eye_rays.h"
#include "alhazen/formats/native/write/native_writer.h"
#include "alhazen/imaging/figures/false_color.h"
#include "alhazen/imaging/image/tone_mapping.h"
#include "alhazen/laboratory/traversal_trace.h"
#include "alhazen/renderers/core/renderer.h"
#include "alhazen/renderers/light_transport/path_settings.h"
#include "alhazen/session/environment_option.h"
#include "alhazen/session/lighting.h"
#include "alhazen/session/render.h"
#include "alhazen/solids/vector_json.h"

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

/// The size of the picture of a camera; of the first if its own is out of range.
FrameSize size_for(const LoadedScene& loaded, double aspect) {
    const PictureSettings& picture = loaded.description.picture;
    try {
        return frame_size(picture, {}, aspect);
    } catch (const Error&) {
        return frame_size(picture, {}, loaded.scene.cameras.front().aspect);
    }
}

json lens_json(const Lens& lens) {
    return {{"radius", lens.radius},
            {"focus_distance", lens.focus_distance},
            {"blades", lens.blades},
            {"turn", lens.turn}};
}

json light_json(const NamedLight& light) {
    json entry{{"name", light.name},
               {"what", light.kind},
               {"color", {light.color.r, light.color.g, light.color.b}}};
    if (light.position) entry["position"] = vector_json(*light.position);
    if (light.direction) entry["direction"] = vector_json(*light.direction);
    for (const ExtentSize& size : light.sizes) {
        entry["sizes"].push_back({{"name", size.name}, {"value", size.value}});
    }
    return entry;
}

/// The position of the added light among the choices.
std::size_t added_choice(const SceneDescription& description) {
    return description.lights.size() - 1;
}

json camera_json(const LoadedScene& loaded, const AddedLights& added, std::size_t i) {
    const CameraDescription& described = loaded.scene.cameras[i];
    const PicturePlane plane = picture_plane(described.camera);
    double aspect = described.aspect;
    FrameSize frame = size_for(loaded, aspect);
    if (std::holds_alternative<WideCamera>(described.camera)) {
        aspect = length(plane.right) / length(plane.up);
        frame.height = std::max(1, static_cast<int>(std::lround(frame.width / aspect)));
    }
    json camera{{"name", described.name},
                {"eye", vector_json(plane.eye)},
                {"look", vector_json(plane.forward)},
                {"right", vector_json(plane.right)},
                {"up", vector_json(plane.up)},
                {"aspect", aspect},
                {"width", frame.width},
                {"height", frame.height},
                {"parallel", std::holds_alternative<OrthographicCamera>(described.camera)},
                {"distance", distance_in_middle(loaded.scene, described.camera)}};
    const auto* const perspective = std::get_if<PerspectiveCamera>(&described.camera);
    if (perspective != nullptr && perspective->lens.radius > 0.0) {
        camera["lens"] = lens_json(perspective->lens);
    }
    if (!described.keys.empty()) {
        camera["block"] = native_camera_text(loaded.description.cameras[i]);
    }
    if (added.is_another(i)) {
        const SceneDescription lights = lights_of(loaded.description, added.of_cameras[i]);
        camera["headlight"] = light_json(light_choices(lights)[added_choice(lights)]);
    }
    return camera;
}

/// The accelerators, after the one of the start if it has a setting.
json accelerator_menu(const std::string& chosen) {
    json menu = json::array();
    const auto& table = accelerator_table();
    const bool known = std::any_of(table.begin(), table.end(),
                                   [&](const auto& entry) { return chosen == entry.name; });
    if (!known) menu.push_back({{"name", chosen}, {"what", "as chosen at the start"}});
    for (const auto& entry : table) {
        menu.push_back({{"name", entry.name}, {"what", entry.description}});
    }
    return menu;
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

json view_menus(const LoadedScene& loaded, const AddedLights& added,
                const std::string& accelerator) {
    const Scene& scene = loaded.scene;
    json lights = json::array(), cameras = json::array();
    for (const NamedLight& light : light_choices(loaded.description)) {
        lights.push_back(light_json(light));
    }
    for (std::size_t i = 0; i < scene.cameras.size(); ++i) {
        cameras.push_back(camera_json(loaded, added, i));
    }
    static const json kRenderers = renderer_menu();
    json menus{{"scene", loaded.description.path.filename().string()},
               {"width", cameras[0]["width"]},
               {"height", cameras[0]["height"]},
               {"up", loaded.description.up_axis == UpAxis::Z ? "z" : "y"},
               {"depth", scene.conventions.shading.max_depth},
               {"cameras", std::move(cameras)},
               {"renderers", kRenderers},
               {"accelerators", accelerator_menu(accelerator)},
               {"lights", std::move(lights)},
               {"environments", menu_of(environments())},
               {"layers", menu_of(aov_table())},
               {"scales",
                {{"heat", scale_json(ColorScale::Colors::Heat)},
                 {"grey", scale_json(ColorScale::Colors::NearGrey)}}},
               {"curves", kToneCurveNames},
               {"steps", traceable_accelerators()}};
    if (added.any) {
        menus["added_light"] = {{"name", menus["lights"][added_choice(loaded.description)]["name"]},
                                {"follows_light", added.follows_light}};
    }
    return menus;
}

}  // namespace alhazen::viewer
