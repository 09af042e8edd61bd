#include <span>
#include <string_view>

#include "alhazen/formats/core/default_conventions.h"
#include "alhazen/formats/native/native_words.h"
#include "alhazen/formats/native/read/native_settings.h"
#include "alhazen/formats/native/write/native_write_context.h"
#include "alhazen/formats/pictures/picture_export.h"
#include "alhazen/imaging/codecs/image_io.h"
#include "alhazen/math/constants.h"
#include "alhazen/shading/lights/ies_profile.h"

namespace alhazen {

namespace {

void add_light_colors(NativeBlockText& block, const Rgb& color, const Rgb& ambient) {
    block.add_unless("color", color, Rgb{1, 1, 1});
    block.add_unless("ambient", ambient, Rgb{});
}

/// Adds the common fields of point and spot lights.
template <class L>
void add_falloff(NativeBlockText& block, const L& light) {
    const auto [constant, linear, quadratic] = light.attenuation;
    block.add_unless("attenuation", Vec3{constant, linear, quadratic}, Vec3{1, 0, 0});
    if (light.range != kNoRange) block.add("range", native_value(light.range));
}

/// Adds an angle in degrees if they convert to the same radians, otherwise in radians.
void add_angle(NativeBlockText& block, const std::string& key, double radians) {
    const double degrees = radians / kRadiansPerDegree;
    if (degrees * kRadiansPerDegree == radians) {
        block.add(key + "_deg", native_value(degrees));
    } else {
        block.add(key + "_rad", native_value(radians));
    }
}

/// `name_of`: returns the name of its file.
template <class NameOf>
void add_profile(NativeBlockText& block, const LightProfile& p, const Vec3& usual_down,
                 const NameOf& name_of) {
    if (!p.profile) return;
    block.add_unless("profile_down", p.down, usual_down);
    block.add_unless("profile_front", p.front, LightProfile{}.front);
    block.add("profile", native_string(name_of(p)));
}

NativeBlockText block_of(const std::string& name, const AmbientLight& light) {
    NativeBlockText block("ambient_light", name);
    block.add("color", native_value(light.ambient));
    return block;
}

NativeBlockText block_of(const std::string& name, const DirectionalLight& light) {
    NativeBlockText block("directional_light", name);
    block.add("to_light", native_value(light.to_light));
    add_light_colors(block, light.color, light.ambient);
    block.add_unless("glints", light.glints, true);
    return block;
}

NativeBlockText block_of(const std::string& name, const PointLight& light) {
    NativeBlockText block("point_light", name);
    block.add("position", native_value(light.position));
    add_light_colors(block, light.color, light.ambient);
    add_falloff(block, light);
    block.add_unless("glints", light.glints, true);
    return block;
}

NativeBlockText block_of(const std::string& name, const SpotLight& light) {
    NativeBlockText block("spot_light", name);
    block.add("position", native_value(light.position));
    block.add("direction", native_value(light.direction));
    add_angle(block, "inner_angle", light.inner_angle);
    add_angle(block, "outer_angle", light.outer_angle);
    add_light_colors(block, light.color, light.ambient);
    add_falloff(block, light);
    return block;
}

std::string point_list(const std::vector<Vec3>& points) {
    return native_list_of(points, [](const Vec3& p) { return native_value(p); });
}

NativeBlockText extent_block(const std::string& name, const RectangleExtent& e) {
    NativeBlockText block("rectangle_light", name);
    block.add("corner", native_value(e.corner));
    block.add("edge_u", native_value(e.edge_u));
    block.add("edge_v", native_value(e.edge_v));
    return block;
}
NativeBlockText extent_block(const std::string& name, const DiscExtent& e) {
    NativeBlockText block("disc_light", name);
    block.add("center", native_value(e.center));
    block.add("normal", native_value(e.normal));
    block.add("radius", native_value(e.radius));
    block.add_unless("inner_radius", e.inner_radius, 0.0);
    return block;
}
NativeBlockText extent_block(const std::string& name, const SphereExtent& e) {
    NativeBlockText block("sphere_light", name);
    block.add("center", native_value(e.center));
    block.add("radius", native_value(e.radius));
    return block;
}
NativeBlockText extent_block(const std::string& name, const TubeExtent& e) {
    NativeBlockText block("tube_light", name);
    block.add("base", native_value(e.base));
    block.add("top", native_value(e.top));
    block.add("radius", native_value(e.radius));
    return block;
}
NativeBlockText extent_block(const std::string& name, const PolygonExtent& e) {
    NativeBlockText block("polygon_light", name);
    block.add("vertices", point_list(e.vertices));
    return block;
}
NativeBlockText extent_block(const std::string& name, const MeshExtent& e) {
    NativeBlockText block("mesh_light", name);
    block.add("points", point_list(e.points));
    block.add("faces", native_list_of(e.triangles, [](const auto& t) {
                  return "(" + std::to_string(t[0]) + ", " + std::to_string(t[1]) + ", " +
                         std::to_string(t[2]) + ")";
              }));
    return block;
}

NativeBlockText block_of(const std::string& name, const AreaLight& light) {
    NativeBlockText block =
        std::visit([&](const auto& e) { return extent_block(name, e); }, light.extent);
    block.add("radiance", native_value(light.radiance));
    block.add_unless("ambient", light.ambient, Rgb{});
    block.add_unless("two_sided", light.two_sided, false);
    block.add_unless("seen", light.seen, true);
    return block;
}

/// The camera blocks without a field of view can express every camera.
NativeBlockText block_of(const std::string& name, const PerspectiveCamera& camera) {
    NativeBlockText block("sheared_camera", name);
    block.add("eye", native_value(camera.eye));
    block.add("look", native_value(camera.look));
    block.add("right", native_value(camera.right));
    block.add("up", native_value(camera.up));
    const Lens& lens = camera.lens;
    const bool plain = lens.radius == 0.0;
    block.add_unless("lens_radius", lens.radius, 0.0);
    if (!plain) block.add("focus_distance", native_value(lens.focus_distance));
    if (plain) block.add_unless("focus_distance", lens.focus_distance, 1.0);
    block.add_unless("blades", lens.blades, 0);
    if (lens.turn != 0.0) add_angle(block, "blade_turn", lens.turn);
    return block;
}

NativeBlockText block_of(const std::string& name, const OrthographicCamera& camera) {
    NativeBlockText block("sheared_orthographic_camera", name);
    block.add("eye", native_value(camera.origin));
    block.add("direction", native_value(camera.direction));
    block.add("right", native_value(camera.right));
    block.add("up", native_value(camera.up));
    return block;
}

NativeBlockText block_of(const std::string& name, const WideCamera& camera) {
    NativeBlockText block("wide_camera", name);
    block.add("eye", native_value(camera.eye));
    block.add("look", native_value(camera.look));
    block.add("right", native_value(camera.right));
    block.add("up", native_value(camera.up));
    block.add("projection", std::string(native_word(camera.projection)));
    block.add("width_rad", native_value(camera.width));
    block.add("height_rad", native_value(camera.height));
    return block;
}

}  // namespace

void write_native_picture(NativeWriteContext& context) {
    const PictureSettings& picture = context.scene.picture;
    NativeBlockText block("picture");
    if (picture.width) block.add("width", native_value(*picture.width));
    if (picture.height) block.add("height", native_value(*picture.height));
    if (picture.background) block.add("background", native_value(*picture.background));
    if (context.scene.shutter != Shutter{}) {
        block.add("shutter",
                  native_value(Vec2{context.scene.shutter.open, context.scene.shutter.close}));
    }
    if (context.scene.up_axis == UpAxis::Z) block.add("up_axis", "z");
    if (!block.empty()) context.append(block);
}

namespace {

/// Environments take colours as they are, whatever alpha says, and have no key for their coding:
/// what is not of codes is written linear, not multiplied by alpha.
PictureFile environment_file(const Image& picture) {
    StoredImage image = stored(picture);
    if (!std::holds_alternative<std::vector<float>>(image.samples)) return picture_file(image);
    Image plain = picture;
    plain.associated = true;
    return {"exr", encode_image("exr", plain, {.full_float = true})};
}

}  // namespace

void write_native_environment(NativeWriteContext& context) {
    if (!context.scene.environment) return;
    const EnvironmentSettings& e = context.scene.environment->settings;
    const EnvironmentSettings usual;
    NativeBlockText block("environment");
    block.add("kind", std::string(native_word(e.kind)));
    if (e.kind == EnvironmentKind::Picture && e.picture) {
        const PictureFile file = environment_file(*e.picture);
        block.add("file",
                  native_string(context.write_file("environment." + file.suffix, file.bytes)));
    }
    block.add_unless("color", e.color, usual.color);
    block.add_unless("scale", e.scale, usual.scale);
    if (e.kind != EnvironmentKind::Constant) {
        if (e.rotation != 0.0) add_angle(block, "rotation", e.rotation);
        if (e.up) block.add("up", native_value(*e.up));
    }
    if (e.kind == EnvironmentKind::Sky) {
        block.add_unless("turbidity", e.turbidity, usual.turbidity);
        if (e.to_sun) block.add("to_sun", native_value(*e.to_sun));
        block.add_unless("ground", e.ground, usual.ground);
    }
    context.append(block);
}

void write_native_conventions(NativeWriteContext& context) {
    const Conventions& c = context.scene.conventions;
    const Conventions usual = default_conventions();
    NativeBlockText block("conventions");
    const auto add_word = [&](std::string_view key, auto value, auto usual_value) {
        if (value != usual_value) block.add(key, std::string(native_word(value)));
    };
    add_word("highlight", c.shading.highlight, usual.shading.highlight);
    add_word("shadow_tint", c.shading.shadow_tint, usual.shading.shadow_tint);
    add_word("refraction_tint", c.shading.refraction_tint, usual.shading.refraction_tint);
    add_word("ambient_factor", c.shading.ambient_factor, usual.shading.ambient_factor);
    block.add_unless("ambient_inside_times_kt", c.shading.ambient_inside_times_kt,
                     usual.shading.ambient_inside_times_kt);
    block.add_unless("ambient_from_eye", c.shading.ambient_from_eye,
                     usual.shading.ambient_from_eye);
    if (c.shading.inside_color) block.add("inside_color", native_value(*c.shading.inside_color));
    block.add_unless("fresnel", c.shading.optics.fresnel, usual.shading.optics.fresnel);
    block.add_unless("beer", c.shading.optics.beer, usual.shading.optics.beer);
    block.add_unless("clamp_attenuation", c.shading.clamp_attenuation,
                     usual.shading.clamp_attenuation);
    block.add_unless("truncate_material_colors", c.importing.truncate_material_colors,
                     usual.importing.truncate_material_colors);
    block.add_unless("transmitting_surfaces_reflect", c.shading.transmitting_surfaces_reflect,
                     usual.shading.transmitting_surfaces_reflect);
    block.add_unless("trace_reflections", c.shading.trace_reflections,
                     usual.shading.trace_reflections);
    block.add_unless("trace_refractions", c.shading.trace_refractions,
                     usual.shading.trace_refractions);
    block.add_unless("correct_interpolated_normals", c.shading.correct_interpolated_normals,
                     usual.shading.correct_interpolated_normals);
    block.add_unless("headlight", c.importing.headlight, usual.importing.headlight);
    block.add_unless("surroundings", c.importing.surroundings, usual.importing.surroundings);
    block.add_unless("air_index", c.shading.air_index, usual.shading.air_index);
    block.add_unless("min_distance", c.shading.min_distance, usual.shading.min_distance);
    add_word("pixel_sample", c.sampling.pixel_sample, usual.sampling.pixel_sample);
    block.add_unless("linear_output", c.film.linear_output, usual.film.linear_output);
    block.add_unless("round_output", c.film.round_output, usual.film.round_output);
    block.add_unless("max_depth", c.shading.max_depth, usual.shading.max_depth);
    block.add_unless("min_contribution", c.shading.min_contribution,
                     usual.shading.min_contribution);
    if (!block.empty()) context.append(block);
}

namespace {

NativeBlockText camera_block(const CameraDescription& camera) {
    NativeBlockText block =
        std::visit([&](const auto& c) { return block_of(camera.name, c); }, camera.camera);
    block.add("aspect", native_value(camera.aspect));
    if (!camera.keys.empty()) block.add("motion", native_value(camera.keys));
    return block;
}

template <class NameOf>
NativeBlockText light_block(const LightDescription& light, const NameOf& name_of) {
    NativeBlockText block =
        std::visit([&](const auto& l) { return block_of(light.name, l); }, light.light);
    if (const auto* point = std::get_if<PointLight>(&light.light)) {
        add_profile(block, point->profile, LightProfile{}.down, name_of);
    } else if (const auto* spot = std::get_if<SpotLight>(&light.light)) {
        add_profile(block, spot->profile, spot->direction, name_of);
    }
    return block;
}

}  // namespace

void write_native_cameras(NativeWriteContext& context) {
    for (const CameraDescription& camera : context.scene.cameras) {
        context.append(camera_block(camera));
    }
}

void write_native_lights(NativeWriteContext& context) {
    for (std::size_t i = 0; i < context.scene.lights.size(); ++i) {
        // Writes the file of a profile beside the scene.
        context.append(light_block(context.scene.lights[i], [&](const LightProfile& p) {
            const std::span<const char> text(p.profile->text());
            return context.write_file("light_" + std::to_string(i) + ".ies", std::as_bytes(text));
        }));
    }
}

std::string native_camera_text(const CameraDescription& camera) {
    return camera_block(camera).text(0) + '\n';
}

std::string native_light_text(const LightDescription& light) {
    return light_block(light, [](const LightProfile& p) { return p.file; }).text(0) + '\n';
}

}  // namespace alhazen
