#include "alhazen/formats/native/read/native_settings.h"

#include <filesystem>
#include <memory>
#include <utility>

#include "alhazen/base/file.h"
#include "alhazen/formats/native/native_words.h"
#include "alhazen/formats/native/read/native_materials.h"
#include "alhazen/formats/native/read/native_view_fields.h"
#include "alhazen/imaging/codecs/image_io.h"

namespace alhazen {

namespace {

void read_pixels(BlockReader& reader, std::string_view key, std::optional<int>& out) {
    int pixels = 0;
    if (!reader.read(key, pixels)) return;
    if (pixels > 0 && pixels <= kMaxPictureSide) {
        out = pixels;
    } else {
        reader.error(*reader.find(key), "'" + std::string(key) + "' must be from 1 to " +
                                            std::to_string(kMaxPictureSide));
    }
}

}  // namespace

void read_picture(const NativeBlock& block, NativeContext& context) {
    if (!block.block) return;
    BlockReader reader = context.reader(*block.block, block.type);
    PictureSettings& picture = context.scene.picture;
    read_pixels(reader, "width", picture.width);
    read_pixels(reader, "height", picture.height);
    Rgb background;
    const auto color = reader.find("background");
    if (color && read_native_color(*color, "background", reader.values(), background)) {
        picture.background = background;
    }
    Vec2 shutter{context.scene.shutter.open, context.scene.shutter.close};
    if (reader.read("shutter", shutter)) context.scene.shutter = {shutter.x, shutter.y};
    reader.read_word("up_axis", native_words<UpAxis>(), context.scene.up_axis);
    reader.finish();
}

namespace {

void read_environment_picture(BlockReader& reader, NativeContext& context,
                              EnvironmentSettings& settings) {
    if (!reader.read("file", settings.file)) return;
    try {
        const auto path = resolve_inside(context.roots, context.folder, settings.file);
        context.diagnostics.note_file(path);
        settings.picture =
            std::make_shared<const Image>(read_image(path, context.options.image_limits));
        if (settings.picture->held.are_none()) {
            context.diagnostics.warning(reader.find("file")->location(), kNoPixelsHeld);
        }
    } catch (const Error& error) {
        if (error.kind() == ErrorKind::Resource) throw;
        reader.error(*reader.find("file"), error.what());
        settings.picture = std::make_shared<const Image>(1, 1, 3);  // prevents a second report
    }
}

/// Reads a vector; sets `out` only if it is given.
void read_given(BlockReader& reader, std::string_view key, std::optional<Vec3>& out) {
    Vec3 v;
    if (reader.read(key, v)) out = v;
}

/// Reads the keys that apply to the kind; others remain unknown.
void read_environment_keys(BlockReader& reader, NativeContext& context,
                           EnvironmentSettings& settings) {
    const auto color = [&](std::string_view key, Rgb& out) {
        const auto value = reader.find(key);
        if (value) read_native_color(*value, key, reader.values(), out);
    };
    if (settings.kind == EnvironmentKind::Picture) {
        reader.require("file");
        read_environment_picture(reader, context, settings);
    }
    color("color", settings.color);
    reader.read("scale", settings.scale);
    if (settings.kind == EnvironmentKind::Constant) return;
    read_angle(reader, "rotation_deg", "rotation_rad", settings.rotation);
    read_given(reader, "up", settings.up);
    if (settings.kind != EnvironmentKind::Sky) return;
    reader.read("turbidity", settings.turbidity);
    read_given(reader, "to_sun", settings.to_sun);
    color("ground", settings.ground);
}

}  // namespace

void read_environment(const NativeBlock& block, NativeContext& context) {
    if (!block.block) return;
    BlockReader reader = context.reader(*block.block, block.type);
    if (context.scene.environment) {
        reader.error(reader.block(), "a scene has one environment");
        return;
    }
    EnvironmentSettings settings;
    reader.require("kind");
    if (reader.read_word("kind", native_words<EnvironmentKind>(), settings.kind)) {
        read_environment_keys(reader, context, settings);
    } else {
        for (const char* key : {"file", "color", "scale", "rotation_deg", "rotation_rad", "up",
                                "turbidity", "to_sun", "ground"}) {
            reader.ignore(key);
        }
    }
    reader.finish();
    context.scene.environment = EnvironmentDescription{std::move(settings), block.location};
}

void read_conventions(const NativeBlock& block, NativeContext& context) {
    using S = ShadingConventions;
    if (!block.block) return;
    BlockReader reader = context.reader(*block.block, block.type);
    Conventions& c = context.scene.conventions;
    reader.read_word("highlight", native_words<S::Highlight>(), c.shading.highlight);
    reader.read_word("shadow_tint", native_words<S::ShadowTint>(), c.shading.shadow_tint);
    reader.read_word("refraction_tint", native_words<S::RefractionTint>(),
                     c.shading.refraction_tint);
    reader.read_word("ambient_factor", native_words<S::AmbientFactor>(), c.shading.ambient_factor);
    reader.read("ambient_inside_times_kt", c.shading.ambient_inside_times_kt);
    reader.read("ambient_from_eye", c.shading.ambient_from_eye);
    if (Rgb inside; reader.read("inside_color", inside)) c.shading.inside_color = inside;
    reader.read("fresnel", c.shading.optics.fresnel);
    reader.read("beer", c.shading.optics.beer);
    reader.read("clamp_attenuation", c.shading.clamp_attenuation);
    reader.read("truncate_material_colors", c.importing.truncate_material_colors);
    reader.read("transmitting_surfaces_reflect", c.shading.transmitting_surfaces_reflect);
    reader.read("trace_reflections", c.shading.trace_reflections);
    reader.read("trace_refractions", c.shading.trace_refractions);
    reader.read("correct_interpolated_normals", c.shading.correct_interpolated_normals);
    reader.read("headlight", c.importing.headlight);
    reader.read("surroundings", c.importing.surroundings);
    if (reader.read("air_index", c.shading.air_index) && !(c.shading.air_index > 0)) {
        reader.error(*reader.find("air_index"), "'air_index' must be greater than 0");
    }
    if (reader.read("min_distance", c.shading.min_distance) && c.shading.min_distance < 0) {
        reader.error(*reader.find("min_distance"), "'min_distance' must not be negative");
    }
    reader.read_word("pixel_sample", native_words<SamplingConventions::PixelSample>(),
                     c.sampling.pixel_sample);
    reader.read("linear_output", c.film.linear_output);
    reader.read("round_output", c.film.round_output);
    if (reader.read("max_depth", c.shading.max_depth) &&
        (c.shading.max_depth < 0 || c.shading.max_depth > 1000)) {
        reader.error(*reader.find("max_depth"), "'max_depth' must be from 0 to 1000");
    }
    if (reader.read("min_contribution", c.shading.min_contribution) &&
        c.shading.min_contribution < 0) {
        reader.error(*reader.find("min_contribution"), "'min_contribution' must not be negative");
    }
    reader.finish();
}

}  // namespace alhazen
