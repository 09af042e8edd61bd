#include "alhazen/formats/native/read/native_lights.h"

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "alhazen/base/file.h"
#include "alhazen/formats/mesh/mesh_lists.h"
#include "alhazen/formats/native/read/native_bent_polygon.h"
#include "alhazen/formats/native/read/native_materials.h"
#include "alhazen/formats/native/read/native_view_fields.h"
#include "alhazen/math/constants.h"
#include "alhazen/shading/lights/ies_profile.h"

namespace alhazen {

namespace {

void read_light_color(BlockReader& reader, std::string_view key, Rgb& color) {
    const auto value = reader.find(key);
    if (!value || !read_native_color(*value, key, reader.values(), color)) return;
    if (color.r < 0 || color.g < 0 || color.b < 0) {
        reader.values().diagnostics.warning(
            value->location(),
            reader.what() + ": '" + std::string(key) +
                "' is negative: this light is subtracted, by renderers of light transport only if "
                "its channels add up to more than 0");
    }
}

void read_emission(BlockReader& reader, Rgb& color, Rgb& ambient) {
    read_light_color(reader, "color", color);
    read_light_color(reader, "ambient", ambient);
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

void read_cone(BlockReader& reader, SpotLight& light) {
    const bool has_inner =
        read_angle(reader, "inner_angle_deg", "inner_angle_rad", light.inner_angle);
    const bool has_outer =
        read_angle(reader, "outer_angle_deg", "outer_angle_rad", light.outer_angle);
    if (has_outer && !has_inner) light.inner_angle = light.outer_angle;
    constexpr double kHalfTurn = 3.1415926535897936;  // as in `validate`: one rounding above pi
    if (!(light.inner_angle >= 0 && light.inner_angle <= light.outer_angle &&
          light.outer_angle <= kHalfTurn)) {
        reader.error(reader.block(), "expected 0 <= inner angle <= outer angle <= 180 degrees");
    }
}

/// Reads the file and the axes of an IES profile.
void read_profile(BlockReader& reader, NativeContext& context, LightProfile& profile) {
    for (const auto& [key, out] :
         {std::pair{"profile_down", &profile.down}, std::pair{"profile_front", &profile.front}}) {
        if (reader.read(key, *out) && !(length_squared(*out) > 0)) {
            reader.error(reader.block(), "'" + std::string(key) + "' must not be zero");
        }
    }
    for (const char* key : {"profile_down", "profile_front"}) reader.needs(key, "profile");
    if (!reader.read("profile", profile.file)) return;
    try {
        const auto path = resolve_inside(context.roots, context.folder, profile.file);
        context.diagnostics.note_file(path);
        profile.profile = std::make_shared<const IesProfile>(
            read_file(path, IesProfile::kMostBytes), profile.file);
        if (const std::string& tilt = profile.profile->ignored_tilt(); !tilt.empty()) {
            context.diagnostics.warning(
                reader.find("profile")->location(),
                "IES profile \"" + printable(profile.file) + "\": TILT=" + printable(tilt) +
                    ", the lamp's output by the tilt of the luminaire, is not applied");
        }
        if (const int line = profile.profile->line_of_surplus(); line != 0) {
            context.diagnostics.warning(
                reader.find("profile")->location(),
                "IES profile \"" + printable(profile.file) + "\": what follows the last candela, " +
                    "from line " + std::to_string(line) +
                    ", is ignored; are the counts of angles " + "too small?");
        }
    } catch (const Error& error) {
        if (error.kind() == ErrorKind::Resource) throw;
        reader.error(*reader.find("profile"), error.what());
    }
}

/// The watts or lumens of a light that emits `per_unit` of them if its colour is 1, as a factor of
/// the colour; none if neither is given.
std::optional<double> read_power(BlockReader& reader, double per_unit) {
    double power = 0;
    if (reader.has("power_watts") && reader.has("lumens")) {
        reader.error(reader.block(),
                     "'power_watts' and 'lumens' exclude each other; expected one of them");
        reader.ignore("lumens");
    }
    if (read_positive(reader, "power_watts", power)) return power / per_unit;
    if (read_positive(reader, "lumens", power)) return power / kLumensPerWatt / per_unit;
    return std::nullopt;
}

void add_light(const NativeBlock& block, NativeContext& context, Light light) {
    context.scene.lights.push_back({block.name, std::move(light), block.location});
}

void read_ambient_light(const NativeBlock& block, NativeContext& context) {
    if (!block.block) return;
    BlockReader reader = context.reader(*block.block, block.type);
    AmbientLight light;
    reader.require("color");
    read_light_color(reader, "color", light.ambient);
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
            light.to_light = key == "to_light" ? vector : -vector;  // `compile` normalises it
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
    const auto times = read_power(reader, of_color_one);
    if (times && !(of_color_one > 0.0)) {
        reader.error(*reader.find("profile"),
                     "the profile \"" + printable(light.profile.file) +
                         "\" emits nothing; no colour gives the light its power");
    } else if (times) {
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
        light.direction = *axis;  // `compile` normalises it
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
    Extent given;
    AreaLight light;
    read_fields(reader, given);
    LightExtent extent = std::move(given);
    replace_bent_polygon(context, block.location, extent);
    if (!reader.has("radiance") && !reader.has("power_watts") && !reader.has("lumens")) {
        reader.error(reader.block(),
                     "'radiance = ...', 'power_watts = ...' or 'lumens = ...' is missing");
    }
    read_light_color(reader, "radiance", light.radiance);
    read_light_color(reader, "ambient", light.ambient);
    reader.read("two_sided", light.two_sided);
    reader.read("seen", light.seen);
    // The given radiance is then only a tint.
    const double area = fault_of(extent) == nullptr ? LightSurface(extent, false).area() : 1;
    if (const auto times = read_power(reader, kPi * area * (light.two_sided ? 2 : 1))) {
        light.radiance = *times * light.radiance;
    }
    reader.finish();
    light.extent = std::move(extent);
    add_light(block, context, light);
}

// ADD A LIGHT HERE: the blocks that make it. An alternative of `Light` without an overload does not
// compile.

std::vector<NativeTopBlock> blocks_of(std::type_identity<AmbientLight>) {
    return {{"ambient_light", read_ambient_light}};
}
std::vector<NativeTopBlock> blocks_of(std::type_identity<DirectionalLight>) {
    return {{"directional_light", read_directional_light}};
}
std::vector<NativeTopBlock> blocks_of(std::type_identity<PointLight>) {
    return {{"point_light", read_point_light}};
}
std::vector<NativeTopBlock> blocks_of(std::type_identity<SpotLight>) {
    return {{"spot_light", read_spot_light}};
}
std::vector<NativeTopBlock> blocks_of(std::type_identity<AreaLight>) {
    return {{"rectangle_light", read_area_light<RectangleExtent>},
            {"disc_light", read_area_light<DiscExtent>},
            {"sphere_light", read_area_light<SphereExtent>},
            {"tube_light", read_area_light<TubeExtent>},
            {"polygon_light", read_area_light<PolygonExtent>},
            {"mesh_light", read_area_light<MeshExtent>}};
}

}  // namespace

std::span<const NativeTopBlock> native_light_blocks() {
    static const std::vector<NativeTopBlock> kBlocks = blocks_of_all(
        std::type_identity<Light>{}, [](auto alternative) { return blocks_of(alternative); });
    return kBlocks;
}

}  // namespace alhazen
