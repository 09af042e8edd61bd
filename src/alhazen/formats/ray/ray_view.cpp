#include "alhazen/formats/ray/ray_view.h"

#include <cmath>
#include <utility>

#include "alhazen/formats/ray/ray_extensions.h"
#include "alhazen/formats/text/block_reader.h"
#include "alhazen/math/constants.h"
#include "alhazen/math/unit_vector.h"

namespace alhazen {

namespace {

BlockReader reader_of(TextNode entry, RayContext& context) {
    return {entry.first(), std::string(entry.text()), BlockReader::Strictness::Tolerant,
            context.diagnostics};
}

/// False, after an error at the value, if it is the zero vector.
bool has_direction(BlockReader& reader, std::string_view key, const Vec3& v) {
    if (length_squared(v) > 0) return true;
    reader.error(reader.find(key).value_or(reader.block()),
                 std::string(key) + " must not be the zero vector");
    return false;
}

/// The axes of a quaternion, vector part first, by the formula for unit quaternions: as in the
/// original programs others give sheared axes.
Mat3 axes_of_quaternion(double x, double y, double z, double w) {
    return {{1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)},
            {2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)},
            {2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)}};
}

Mat3 axes_of(const Vec3& view, const Vec3& up) {
    return {cross(up, -view), up, -view};
}

/// The axes of a camera that looks at its point `look_at`. Those of `camera` where there are none,
/// which is an error unless a later block moves the camera. As in the original programs `updir` is
/// kept as written, and without one the axes are perpendicular.
Mat3 axes_towards(BlockReader& reader, RayCamera& camera, bool normalise) {
    const Vec3 view = unit_or(*camera.look_at - camera.eye, {});
    Vec3 up;
    if (camera.up) {
        if (!has_direction(reader, "updir", *camera.up)) return camera.axes;
        up = normalise ? normalize(*camera.up) : *camera.up;
    } else if (view.x == 0 && view.z == 0) {
        up = {1, 0, 0};
    } else {
        up = cross(normalize(cross(view, {0, 1, 0})), view);
    }
    const Mat3 axes = axes_of(view, up);
    if (length_squared(axes.x_axis) > 0) return axes;
    camera.without_axes = reader.find("look_at").value_or(reader.block()).location();
    return camera.axes;
}

/// The camera axes. As in the original programs, lengths and angles given in the file are kept;
/// those of `camera` hold where the file says nothing.
Mat3 read_axes(BlockReader& reader, RayCamera& camera, bool normalise) {
    Mat3& axes = camera.axes;
    camera.without_axes.reset();
    double q[4];
    // The first is the spelling of the reference.
    const auto turn = reader.find("quaternian", "quaternion");
    if (turn && reader.values().read_numbers(*turn, "quaternion", 4, q)) {
        axes = axes_of_quaternion(q[0], q[1], q[2], q[3]);
        camera.look_at.reset();
    }
    if (turn && (reader.has("viewdir") || reader.has("look_at"))) {
        reader.values().diagnostics.warning(
            turn->location(), "camera: a quaternion has no effect beside viewdir or look_at");
    }
    if (reader.has("viewdir")) {
        if (const auto point = reader.find("look_at")) {
            reader.values().diagnostics.warning(
                point->location(), "camera: look_at has no effect beside viewdir and updir");
        }
        camera.look_at.reset();
    }
    Vec3 point, view, up;
    if (!reader.has("viewdir") && reader.read("look_at", point)) camera.look_at = point;
    if (camera.look_at) {
        if (reader.read("updir", up)) camera.up = up;
        return axes_towards(reader, camera, normalise);
    }
    const bool has_view = reader.read("viewdir", view), has_up = reader.read("updir", up);
    if (reader.has("viewdir") != reader.has("updir")) {
        reader.error(reader.block(), "viewdir and updir must be given together");
    }
    if (!has_view || !has_up || !has_direction(reader, "viewdir", view) ||
        !has_direction(reader, "updir", up)) {
        return axes;
    }
    if (normalise) {
        view = normalize(view);
        up = normalize(up);
    }
    return axes_of(view, up);
}

void refuse_lens(BlockReader& reader) {
    double aperture = 0;
    bool motion_blur = false;
    if (reader.read("aperture", aperture) && aperture != 0) {
        reader.error(reader.block(), refusal("camera key", "aperture", "depth of field, HKUST"));
    }
    if (reader.read("enable_motion_blur", motion_blur) && motion_blur) {
        reader.error(reader.block(),
                     refusal("camera key", "enable_motion_blur", "motion blur, HKUST"));
    }
    for (const char* key : {"focaldistance", "time0", "time1"}) reader.ignore(key);
}

void read_camera(TextNode entry, RayContext& context) {
    BlockReader reader = reader_of(entry, context);
    RayCamera& own = context.camera;
    reader.read("position", own.eye);
    own.axes = read_axes(reader, own, context.family.dictionary);
    double aspect = 1, fov_deg = 0;
    const auto ratio = reader.find("aspectratio"), fov = reader.find("fov");
    if (ratio && reader.values().read(*ratio, "aspectratio", aspect)) {
        if (aspect > 0) {
            own.aspect = aspect;
        } else {
            reader.error(*ratio, "aspectratio must be greater than 0");
        }
    }
    if (fov && reader.values().read(*fov, "fov", fov_deg)) {
        if (fov_deg > 0 && fov_deg < 180) {
            own.height = 2 * std::tan(0.5 * fov_deg * kRadiansPerDegree);
        } else {
            reader.error(*fov, "fov must be between 0 and 180 degrees");
        }
    }
    refuse_lens(reader);
    reader.finish();
    PerspectiveCamera camera;
    camera.eye = own.eye;
    camera.look = -own.axes.z_axis;
    camera.right = own.height * own.aspect * own.axes.x_axis;
    camera.up = own.height * own.axes.y_axis;
    if (!context.scene.cameras.empty()) {
        context.diagnostics.warning(entry.location(),
                                    "another camera block changes the camera of the first");
        context.scene.cameras.clear();
    }
    context.scene.cameras.push_back({"", camera, own.aspect, entry.location()});
}

Rgb read_color(BlockReader& reader) {
    Rgb color;
    if (const auto value = reader.find("color", "colour")) {
        reader.values().read(*value, "color", color);
    }
    if (!reader.has("colour")) reader.require("color");
    return color;
}

Attenuation read_attenuation(BlockReader& reader, bool dictionary) {
    // Defaults: 1 / d^2 in the token parsers, no attenuation in the dictionary parsers.
    Attenuation a = dictionary ? Attenuation{1, 0, 0} : Attenuation{0, 0, 1};
    reader.read("constant_attenuation_coeff", a.constant);
    reader.read("linear_attenuation_coeff", a.linear);
    reader.read("quadratic_attenuation_coeff", a.quadratic);
    if (a.constant < 0 || a.linear < 0 || a.quadratic < 0) {
        reader.error(reader.block(), "attenuation coefficients must not be negative");
        return {};
    }
    return a;
}

void add_light(TextNode entry, RayContext& context, Light light) {
    context.scene.lights.push_back({"", std::move(light), entry.location()});
}

void read_ambient_light(TextNode entry, RayContext& context) {
    BlockReader reader = reader_of(entry, context);
    const Rgb color = read_color(reader);
    reader.finish();
    add_light(entry, context, AmbientLight{color});
}

void read_directional_light(TextNode entry, RayContext& context) {
    BlockReader reader = reader_of(entry, context);
    DirectionalLight light;
    light.color = read_color(reader);
    reader.require("direction");
    Vec3 direction;
    if (reader.read("direction", direction) && has_direction(reader, "direction", direction)) {
        light.to_light = normalize(-direction);
    }
    reader.finish();
    add_light(entry, context, light);
}

PointLight read_point(BlockReader& reader, RayContext& context) {
    PointLight light;
    light.color = read_color(reader);
    reader.require("position");
    reader.read("position", light.position);
    light.attenuation = read_attenuation(reader, context.family.dictionary);
    return light;
}

void read_point_light(TextNode entry, RayContext& context) {
    BlockReader reader = reader_of(entry, context);
    const PointLight light = read_point(reader, context);
    reader.finish();
    add_light(entry, context, light);
}

/// Reads an area light: one of radius 0 is a point light; other radii would need soft shadows.
void read_area_light(TextNode entry, RayContext& context) {
    BlockReader reader = reader_of(entry, context);
    double radius = 1;
    if (reader.has("u") || reader.has("v") || !reader.read("light_radius", radius) || radius != 0) {
        context.diagnostics.error(
            entry.location(),
            refusal("light", "area_light", "lights with an extent, UT Austin and HKUST students"));
        return;
    }
    const PointLight light = read_point(reader, context);
    reader.finish();
    add_light(entry, context, light);
}

/// The half angles of the cone in degrees, in any of the spellings.
std::pair<double, double> read_spot_cone(BlockReader& reader) {
    double full = 0, blend = 0, penumbra = 0, edge[3];
    if (reader.read("size", full)) {
        reader.read("blend", blend);
        return {0.5 * full * (1 - blend), 0.5 * full};
    }
    if (reader.read("cone_angle", full)) {
        reader.read("penumbra", penumbra);
        return {0.5 * full, 0.5 * full + penumbra};
    }
    const auto value = reader.find("edgeplace");
    if (value && reader.values().read_numbers(*value, "edgeplace", 3, edge)) {
        if (edge[1] != 0 || edge[2] != 0) {
            reader.error(*value, "edgeplace: only (degrees, 0, 0), a sharp edge, is supported");
        }
        return {edge[0], edge[0]};
    }
    for (const char* key : {"size", "cone_angle", "edgeplace"}) {
        if (reader.has(key)) return {0, 45};  // the value was reported as an error
    }
    reader.error(reader.block(), "one of size, cone_angle, edgeplace is missing");
    return {0, 45};
}

void read_spot_light(TextNode entry, RayContext& context) {
    BlockReader reader = reader_of(entry, context);
    const PointLight point = read_point(reader, context);
    SpotLight light{.position = point.position,
                    .color = point.color,
                    .attenuation = point.attenuation,
                    .ambient = {}};
    Vec3 direction, target;
    if (reader.read("direction", direction)) {
        if (has_direction(reader, "direction", direction)) light.direction = normalize(direction);
    } else if (reader.read("target", target)) {
        direction = target - light.position;
        if (has_direction(reader, "target", direction)) light.direction = normalize(direction);
    } else if (!reader.has("direction") && !reader.has("target")) {
        reader.error(reader.block(), "one of direction, target is missing");
    }
    const auto [inner, outer] = read_spot_cone(reader);
    if (inner < 0 || inner > outer || !(outer > 0) || outer > 180) {
        reader.error(reader.block(), "the cone's angles must be in 0 <= inner <= outer <= 180");
    }
    if (reader.has("cutoff_distance")) {
        reader.ignore("cutoff_distance");
        reader.error(reader.block(),
                     refusal("light key", "cutoff_distance", "lights that end, HKUST"));
    }
    light.inner_angle = inner * kRadiansPerDegree;
    light.outer_angle = outer * kRadiansPerDegree;
    reader.finish();
    add_light(entry, context, light);
}

using Read = void (*)(TextNode, RayContext&);
constexpr std::pair<std::string_view, Read> kReaders[] = {
    {"camera", read_camera},
    {"ambient_light", read_ambient_light},
    {"directional_light", read_directional_light},
    {"point_light", read_point_light},
    {"area_light", read_area_light},
    {"spot_light", read_spot_light},
};

}  // namespace

bool is_ray_camera_or_light(std::string_view name) {
    for (const auto& [known, read] : kReaders) {
        if (known == name) return true;
    }
    return false;
}

std::vector<std::string_view> ray_cameras_and_lights() {
    std::vector<std::string_view> names;
    for (const auto& [name, read] : kReaders) names.push_back(name);
    return names;
}

void read_ray_camera_or_light(TextNode entry, RayContext& context) {
    if (entry.empty() || !entry.first().is(NodeKind::Block)) {
        context.diagnostics.error(entry.location(),
                                  std::string(entry.text()) + ": expected a block { }");
        return;
    }
    for (const auto& [name, read] : kReaders) {
        if (name == entry.text()) read(entry, context);
    }
}

}  // namespace alhazen
