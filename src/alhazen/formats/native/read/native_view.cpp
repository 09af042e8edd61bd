#include "alhazen/formats/native/read/native_view.h"

#include <cmath>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "alhazen/base/file.h"
#include "alhazen/formats/mesh/mesh_lists.h"
#include "alhazen/formats/native/native_words.h"
#include "alhazen/formats/native/read/native_materials.h"
#include "alhazen/formats/native/read/native_transform.h"
#include "alhazen/math/constants.h"
#include "alhazen/shading/lights/ies_profile.h"

namespace alhazen {

namespace {

/// Requires exactly one of the keys; returns it.
std::string_view require_one_of(BlockReader& reader, std::string_view a, std::string_view b) {
    if (reader.has(a) == reader.has(b)) {
        reader.error(reader.block(), "expected either '" + std::string(a) + " = ...' or '" +
                                         std::string(b) + " = ...'");
    }
    return reader.has(a) ? a : b;
}

/// The vector from `origin` to a point, or a direction; nothing, after an error, when it is zero.
std::optional<Vec3> read_direction(BlockReader& reader, const Vec3& origin,
                                   std::string_view point_key, std::string_view direction_key) {
    Vec3 point, direction;
    reader.ignore(point_key);
    reader.ignore(direction_key);
    const std::string_view key = require_one_of(reader, point_key, direction_key);
    if (key == point_key) {
        if (!reader.read(key, point)) return std::nullopt;
        direction = point - origin;
    } else if (!reader.read(key, direction)) {
        return std::nullopt;
    }
    if (length_squared(direction) > 0) return direction;
    reader.error(reader.block(), "'" + std::string(key) + "' gives no direction");
    return std::nullopt;
}

bool read_positive(BlockReader& reader, std::string_view key, double& out) {
    double value = 0;
    if (!reader.read(key, value)) return false;
    if (value > 0) {
        out = value;
        return true;
    }
    reader.error(reader.block(), "'" + std::string(key) + "' must be greater than 0");
    return false;
}

struct View {
    Vec3 eye, look{0, 0, -1}, up{0, 1, 0};
    double aspect = 1;
};

View read_view(BlockReader& reader, NativeContext& context) {
    View view;
    reader.require("eye");
    reader.read("eye", view.eye);
    if (const auto look = read_direction(reader, view.eye, "look_at", "direction")) {
        view.look = *look;
    }
    reader.read("up", view.up);
    const Vec3 side = cross(normalize(view.look), view.up);
    if (!(length_squared(side) > 0)) {
        reader.error(reader.block(), "'up' must not be zero or along the view");
        view.up = perpendicular(normalize(view.look));
    }
    if (!read_positive(reader, "aspect", view.aspect)) {
        context.cameras_without_aspect.push_back(context.scene.cameras.size());
    }
    return view;
}

void add_camera(const NativeBlock& block, NativeContext& context, const Camera& camera,
                double aspect, std::vector<TransformKey> keys) {
    context.scene.cameras.push_back({block.name, camera, aspect, block.location, std::move(keys)});
}

void read_emission(BlockReader& reader, Rgb& color, Rgb& ambient) {
    for (const auto& [key, out] : {std::pair{"color", &color}, std::pair{"ambient", &ambient}}) {
        if (const auto value = reader.find(key)) {
            read_native_color(*value, key, reader.values(), *out);
        }
    }
}

void read_attenuation(BlockReader& reader, Attenuation& attenuation) {
    double v[3];
    const auto value = reader.find("attenuation");
    if (!value || !reader.values().read_numbers(*value, "attenuation", 3, v)) return;
    if (v[0] < 0 || v[1] < 0 || v[2] < 0) {
        reader.error(*value, "attenuation: expected (constant, linear, quadratic), none negative");
        return;
    }
    attenuation = {v[0], v[1], v[2]};
}

/// An angle in degrees or, for an exact value, in radians; true when it is present.
bool read_angle(BlockReader& reader, std::string_view degrees_key, std::string_view radians_key,
                double& radians) {
    double degrees = 0;
    if (reader.has(degrees_key) && reader.has(radians_key)) {
        reader.error(reader.block(), "'" + std::string(degrees_key) + "' and '" +
                                         std::string(radians_key) +
                                         "' say the same; expected one of them");
    }
    if (reader.read(degrees_key, degrees)) radians = degrees * kRadiansPerDegree;
    reader.read(radians_key, radians);
    return reader.has(degrees_key) || reader.has(radians_key);
}

void read_cone(BlockReader& reader, SpotLight& light) {
    const bool has_inner =
        read_angle(reader, "inner_angle_deg", "inner_angle_rad", light.inner_angle);
    const bool has_outer =
        read_angle(reader, "outer_angle_deg", "outer_angle_rad", light.outer_angle);
    if (has_outer && !has_inner) light.inner_angle = light.outer_angle;
    constexpr double kHalfTurn = 3.1415926535897936;  // as `validate`: one rounding beyond pi
    if (!(light.inner_angle >= 0 && light.inner_angle <= light.outer_angle &&
          light.outer_angle <= kHalfTurn)) {
        reader.error(reader.block(), "expected 0 <= inner angle <= outer angle <= 180 degrees");
    }
}

/// A radius above 0 makes a lens; `focus_at` is a point in the plane of focus.
void read_lens(BlockReader& reader, PerspectiveCamera& camera) {
    const bool has_lens = reader.read("lens_radius", camera.lens.radius);
    double turn_deg = camera.lens.turn / kRadiansPerDegree;
    Vec3 at;
    reader.read("blades", camera.lens.blades);
    if (reader.read("blade_turn_deg", turn_deg)) camera.lens.turn = turn_deg * kRadiansPerDegree;
    reader.read("blade_turn_rad", camera.lens.turn);
    reader.read("focus_distance", camera.lens.focus_distance);
    const bool has_point = reader.read("focus_at", at);
    if (has_point) {
        const Vec3 normal = normalize(cross(camera.up, camera.right));
        camera.lens.focus_distance = std::abs(dot(at - camera.eye, normal));
    }
    if (has_point && reader.has("focus_distance")) {
        reader.error(reader.block(),
                     "'focus_at' and 'focus_distance' say the same; expected one "
                     "of them");
    }
    if (has_lens && camera.lens.radius > 0 && !has_point && !reader.has("focus_distance")) {
        reader.error(reader.block(),
                     "a lens needs 'focus_distance = ...' or 'focus_at = (x, y, z)'");
    }
}

/// The axes of an IES profile, and the file.
void read_profile(BlockReader& reader, NativeContext& context, LightProfile& profile) {
    for (const auto& [key, out] :
         {std::pair{"profile_down", &profile.down}, std::pair{"profile_front", &profile.front}}) {
        if (reader.read(key, *out) && !(length_squared(*out) > 0)) {
            reader.error(reader.block(), "'" + std::string(key) + "' must not be zero");
        }
    }
    if (!reader.read("profile", profile.file)) return;
    try {
        const auto path = resolve_inside(context.roots, context.folder, profile.file);
        context.diagnostics.note_file(path);
        profile.profile = std::make_shared<const IesProfile>(
            read_file(path, IesProfile::kMostBytes), profile.file);
    } catch (const Error& error) {
        if (error.kind() == ErrorKind::Resource) throw;
        reader.error(*reader.find("profile"), error.what());
    }
}

/// Watts or lumens of a light that sends `per_unit` of them where its colour is 1; nothing where
/// neither is given.
std::optional<double> read_power(BlockReader& reader, double per_unit) {
    double power = 0;
    if (reader.has("power_watts") && reader.has("lumens")) {
        reader.error(reader.block(),
                     "'power_watts' and 'lumens' say the same; expected one of them");
    }
    if (read_positive(reader, "power_watts", power)) return power / per_unit;
    if (read_positive(reader, "lumens", power)) return power / kLumensPerWatt / per_unit;
    return std::nullopt;
}

void add_light(const NativeBlock& block, NativeContext& context, Light light) {
    context.scene.lights.push_back({block.name, std::move(light), block.location});
}

void read_perspective_camera(const NativeBlock& block, NativeContext& context) {
    if (!block.block) return;
    BlockReader reader = context.reader(*block.block, block.type);
    const View view = read_view(reader, context);
    double fov_deg = 45;
    if (reader.read("fov_deg", fov_deg) && !(fov_deg > 0 && fov_deg < 180)) {
        reader.error(reader.block(), "'fov_deg' must be between 0 and 180");
        fov_deg = 45;
    }
    PerspectiveCamera camera =
        look_along(view.eye, view.look, view.up, fov_deg * kRadiansPerDegree, view.aspect);
    read_lens(reader, camera);
    std::vector<TransformKey> keys = read_native_motion(reader);
    reader.finish();
    add_camera(block, context, camera, view.aspect, std::move(keys));
}

void read_sheared_camera(const NativeBlock& block, NativeContext& context) {
    if (!block.block) return;
    BlockReader reader = context.reader(*block.block, block.type);
    PerspectiveCamera camera;
    double aspect = 1;
    for (const char* key : {"eye", "look", "right", "up", "aspect"}) reader.require(key);
    reader.read("eye", camera.eye);
    reader.read("look", camera.look);
    reader.read("right", camera.right);
    reader.read("up", camera.up);
    read_positive(reader, "aspect", aspect);
    read_lens(reader, camera);
    std::vector<TransformKey> keys = read_native_motion(reader);
    reader.finish();
    add_camera(block, context, camera, aspect, std::move(keys));
}

void read_sheared_orthographic_camera(const NativeBlock& block, NativeContext& context) {
    if (!block.block) return;
    BlockReader reader = context.reader(*block.block, block.type);
    OrthographicCamera camera;
    double aspect = 1;
    for (const char* key : {"eye", "direction", "right", "up", "aspect"}) reader.require(key);
    reader.read("eye", camera.origin);
    reader.read("direction", camera.direction);
    reader.read("right", camera.right);
    reader.read("up", camera.up);
    read_positive(reader, "aspect", aspect);
    std::vector<TransformKey> keys = read_native_motion(reader);
    reader.finish();
    add_camera(block, context, camera, aspect, std::move(keys));
}

void read_orthographic_camera(const NativeBlock& block, NativeContext& context) {
    if (!block.block) return;
    BlockReader reader = context.reader(*block.block, block.type);
    const View view = read_view(reader, context);
    double height = 1;
    reader.require("height");
    read_positive(reader, "height", height);
    std::vector<TransformKey> keys = read_native_motion(reader);
    reader.finish();
    add_camera(block, context,
               look_along_parallel(view.eye, view.look, view.up, height, view.aspect), view.aspect,
               std::move(keys));
}

void read_fisheye_camera(const NativeBlock& block, NativeContext& context) {
    if (!block.block) return;
    BlockReader reader = context.reader(*block.block, block.type);
    const View view = read_view(reader, context);
    double fov_deg = 180;
    if (reader.read("fov_deg", fov_deg) && !(fov_deg > 0 && fov_deg <= 360)) {
        reader.error(reader.block(), "'fov_deg' must be above 0 and at most 360");
        fov_deg = 180;
    }
    WideProjection projection = WideProjection::Equidistant;
    reader.read_word("projection", native_words<WideProjection>(), projection);
    if (projection == WideProjection::Panorama) {
        reader.error(*reader.find("projection"),
                     "'projection' of a fisheye must be equidistant or equisolid; for the other "
                     "there is 'panorama_camera'");
        projection = WideProjection::Equidistant;
    }
    std::vector<TransformKey> keys = read_native_motion(reader);
    reader.finish();
    add_camera(block, context,
               look_around(view.eye, view.look, view.up, projection, fov_deg * kRadiansPerDegree,
                           view.aspect),
               view.aspect, std::move(keys));
}

/// Its aspect ratio is that of its angles.
void read_panorama_camera(const NativeBlock& block, NativeContext& context) {
    if (!block.block) return;
    BlockReader reader = context.reader(*block.block, block.type);
    const std::size_t without = context.cameras_without_aspect.size();
    View view = read_view(reader, context);
    double width_deg = 360, height_deg = 180;
    const auto read_degrees = [&](const char* key, double most, double& degrees) {
        if (reader.read(key, degrees) && !(degrees > 0 && degrees <= most)) {
            reader.error(*reader.find(key), "'" + std::string(key) +
                                                "' must be above 0 and at most " +
                                                std::to_string(static_cast<int>(most)));
            degrees = most;
        }
    };
    read_degrees("width_deg", 360, width_deg);
    read_degrees("height_deg", 180, height_deg);
    const double ratio = width_deg / height_deg;
    if (context.cameras_without_aspect.size() > without) {
        context.cameras_without_aspect.pop_back();
        view.aspect = ratio;
    }
    std::vector<TransformKey> keys = read_native_motion(reader);
    reader.finish();
    add_camera(block, context,
               look_around(view.eye, view.look, view.up, WideProjection::Panorama,
                           height_deg * kRadiansPerDegree, ratio),
               view.aspect, std::move(keys));
}

void read_wide_camera(const NativeBlock& block, NativeContext& context) {
    if (!block.block) return;
    BlockReader reader = context.reader(*block.block, block.type);
    WideCamera camera;
    double aspect = 1;
    for (const char* key :
         {"eye", "look", "right", "up", "projection", "width_rad", "height_rad", "aspect"}) {
        reader.require(key);
    }
    reader.read("eye", camera.eye);
    reader.read("look", camera.look);
    reader.read("right", camera.right);
    reader.read("up", camera.up);
    reader.read_word("projection", native_words<WideProjection>(), camera.projection);
    read_positive(reader, "width_rad", camera.width);
    read_positive(reader, "height_rad", camera.height);
    read_positive(reader, "aspect", aspect);
    std::vector<TransformKey> keys = read_native_motion(reader);
    reader.finish();
    add_camera(block, context, camera, aspect, std::move(keys));
}

void read_ambient_light(const NativeBlock& block, NativeContext& context) {
    if (!block.block) return;
    BlockReader reader = context.reader(*block.block, block.type);
    AmbientLight light;
    reader.require("color");
    if (const auto value = reader.find("color")) {
        read_native_color(*value, "color", reader.values(), light.ambient);
    }
    reader.finish();
    add_light(block, context, light);
}

void read_directional_light(const NativeBlock& block, NativeContext& context) {
    if (!block.block) return;
    BlockReader reader = context.reader(*block.block, block.type);
    DirectionalLight light;
    Vec3 vector;
    reader.ignore("direction");
    reader.ignore("to_light");
    const std::string_view key = require_one_of(reader, "direction", "to_light");
    if (reader.read(key, vector)) {
        if (length_squared(vector) > 0) {
            light.to_light = key == "to_light" ? vector : -vector;  // normalised by `compile`
        } else {
            reader.error(reader.block(), "'" + std::string(key) + "' must not be zero");
        }
    }
    read_emission(reader, light.color, light.ambient);
    reader.read("glints", light.glints);
    reader.finish();
    add_light(block, context, light);
}

void read_point_light(const NativeBlock& block, NativeContext& context) {
    if (!block.block) return;
    BlockReader reader = context.reader(*block.block, block.type);
    PointLight light;
    reader.require("position");
    reader.read("position", light.position);
    read_emission(reader, light.color, light.ambient);
    read_attenuation(reader, light.attenuation);
    read_positive(reader, "range", light.range);
    reader.read("glints", light.glints);
    read_profile(reader, context, light.profile);
    // Intensity is pi times the colour (illumination.h).
    const double of_color_one = 4 * kPi * kPi * mean_factor(light.profile);
    if (const auto times = read_power(reader, of_color_one)) {
        light.color = *times * light.color;
        if (!reader.has("attenuation")) light.attenuation = {0, 0, 1};
    }
    reader.finish();
    add_light(block, context, light);
}

void read_spot_light(const NativeBlock& block, NativeContext& context) {
    if (!block.block) return;
    BlockReader reader = context.reader(*block.block, block.type);
    SpotLight light;
    reader.require("position");
    reader.read("position", light.position);
    if (const auto axis = read_direction(reader, light.position, "look_at", "direction")) {
        light.direction = *axis;  // normalised by `compile`
    }
    read_cone(reader, light);
    read_emission(reader, light.color, light.ambient);
    read_attenuation(reader, light.attenuation);
    read_positive(reader, "range", light.range);
    if (reader.has("profile")) light.profile.down = light.direction;
    read_profile(reader, context, light.profile);
    reader.finish();
    add_light(block, context, light);
}

void read_fields(BlockReader& reader, RectangleExtent& e) {
    for (const char* key : {"corner", "edge_u", "edge_v"}) reader.require(key);
    reader.read("corner", e.corner);
    reader.read("edge_u", e.edge_u);
    reader.read("edge_v", e.edge_v);
}
void read_fields(BlockReader& reader, DiscExtent& e) {
    for (const char* key : {"center", "normal", "radius"}) reader.require(key);
    reader.read("center", e.center);
    reader.read("normal", e.normal);
    reader.read("radius", e.radius);
    reader.read("inner_radius", e.inner_radius);
}
void read_fields(BlockReader& reader, SphereExtent& e) {
    for (const char* key : {"center", "radius"}) reader.require(key);
    reader.read("center", e.center);
    reader.read("radius", e.radius);
}
void read_fields(BlockReader& reader, TubeExtent& e) {
    for (const char* key : {"base", "top", "radius"}) reader.require(key);
    reader.read("base", e.base);
    reader.read("top", e.top);
    reader.read("radius", e.radius);
}
void read_fields(BlockReader& reader, PolygonExtent& e) {
    TriangleMesh points;
    reader.require("vertices");
    const auto list = reader.find("vertices");
    if (list && read_points(*list, "vertices", reader.values(), points)) {
        e.vertices = std::move(points.positions);
    }
}
void read_fields(BlockReader& reader, MeshExtent& e) {
    TriangleMesh mesh;
    reader.require("points");
    reader.require("faces");
    const auto points = reader.find("points"), faces = reader.find("faces");
    if (!points || !read_points(*points, "points", reader.values(), mesh)) return;
    if (faces) read_faces(*faces, "faces", reader.values(), mesh);
    e = {std::move(mesh.positions), std::move(mesh.triangles)};
}

template <class Extent>
void read_area_light(const NativeBlock& block, NativeContext& context) {
    if (!block.block) return;
    BlockReader reader = context.reader(*block.block, block.type);
    Extent extent;
    AreaLight light;
    read_fields(reader, extent);
    if (!reader.has("power_watts") && !reader.has("lumens")) reader.require("radiance");
    if (const auto value = reader.find("radiance")) {
        read_native_color(*value, "radiance", reader.values(), light.radiance);
    }
    if (const auto value = reader.find("ambient")) {
        read_native_color(*value, "ambient", reader.values(), light.ambient);
    }
    reader.read("two_sided", light.two_sided);
    reader.read("seen", light.seen);
    // The radiance is then a tint.
    const double area = fault_of(extent) == nullptr ? LightSurface(extent, false).area() : 1;
    if (const auto times = read_power(reader, kPi * area * (light.two_sided ? 2 : 1))) {
        light.radiance = *times * light.radiance;
    }
    reader.finish();
    light.extent = std::move(extent);
    add_light(block, context, light);
}

// ADD A CAMERA OR A LIGHT HERE: the blocks that make it. An alternative of `Camera` or `Light`
// without an overload does not compile.

using Blocks = std::vector<NativeTopBlock>;

Blocks blocks_of(std::type_identity<PerspectiveCamera>) {
    return {{"perspective_camera", read_perspective_camera},
            {"sheared_camera", read_sheared_camera}};
}
Blocks blocks_of(std::type_identity<OrthographicCamera>) {
    return {{"orthographic_camera", read_orthographic_camera},
            {"sheared_orthographic_camera", read_sheared_orthographic_camera}};
}
Blocks blocks_of(std::type_identity<WideCamera>) {
    return {{"fisheye_camera", read_fisheye_camera},
            {"panorama_camera", read_panorama_camera},
            {"wide_camera", read_wide_camera}};
}
Blocks blocks_of(std::type_identity<AmbientLight>) {
    return {{"ambient_light", read_ambient_light}};
}
Blocks blocks_of(std::type_identity<DirectionalLight>) {
    return {{"directional_light", read_directional_light}};
}
Blocks blocks_of(std::type_identity<PointLight>) {
    return {{"point_light", read_point_light}};
}
Blocks blocks_of(std::type_identity<SpotLight>) {
    return {{"spot_light", read_spot_light}};
}

Blocks blocks_of(std::type_identity<AreaLight>) {
    return {{"rectangle_light", read_area_light<RectangleExtent>},
            {"disc_light", read_area_light<DiscExtent>},
            {"sphere_light", read_area_light<SphereExtent>},
            {"tube_light", read_area_light<TubeExtent>},
            {"polygon_light", read_area_light<PolygonExtent>},
            {"mesh_light", read_area_light<MeshExtent>}};
}

template <class... Alternatives>
void append_blocks(std::type_identity<std::variant<Alternatives...>>, Blocks& blocks) {
    const auto append = [&](const Blocks& more) {
        blocks.insert(blocks.end(), more.begin(), more.end());
    };
    (append(blocks_of(std::type_identity<Alternatives>{})), ...);
}

}  // namespace

std::span<const NativeTopBlock> native_view_blocks() {
    static const Blocks kBlocks = [] {
        Blocks blocks;
        append_blocks(std::type_identity<Camera>{}, blocks);
        append_blocks(std::type_identity<Light>{}, blocks);
        return blocks;
    }();
    return kBlocks;
}

void complete_cameras(NativeContext& context) {
    const PictureSettings& picture = context.scene.picture;
    if (!picture.width || !picture.height) return;
    const double aspect = static_cast<double>(*picture.width) / *picture.height;
    for (const std::size_t i : context.cameras_without_aspect) {
        CameraDescription& camera = context.scene.cameras[i];
        camera.camera = with_aspect(camera.camera, camera.aspect, aspect);
        camera.aspect = aspect;
    }
}

}  // namespace alhazen
