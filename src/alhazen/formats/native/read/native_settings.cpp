#include "alhazen/formats/native/read/native_settings.h"

#include "alhazen/formats/native/native_words.h"
#include "alhazen/formats/native/read/native_materials.h"

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
    reader.read_word("up_axis", native_words<UpAxis>(), context.scene.up_axis);
    reader.finish();
}

void read_conventions(const NativeBlock& block, NativeContext& context) {
    using C = ShadingConventions;
    if (!block.block) return;
    BlockReader reader = context.reader(*block.block, block.type);
    C& c = context.scene.conventions;
    reader.read_word("highlight", native_words<C::Highlight>(), c.highlight);
    reader.read_word("shadow_tint", native_words<C::ShadowTint>(), c.shadow_tint);
    reader.read_word("refraction_tint", native_words<C::RefractionTint>(), c.refraction_tint);
    reader.read_word("ambient_factor", native_words<C::AmbientFactor>(), c.ambient_factor);
    reader.read("ambient_inside_times_kt", c.ambient_inside_times_kt);
    reader.read("clamp_attenuation", c.clamp_attenuation);
    reader.read("truncate_material_colors", c.truncate_material_colors);
    reader.read("transmitting_surfaces_reflect", c.transmitting_surfaces_reflect);
    reader.read("trace_reflections", c.trace_reflections);
    reader.read("trace_refractions", c.trace_refractions);
    reader.read("correct_interpolated_normals", c.correct_interpolated_normals);
    reader.read("headlight", c.headlight);
    if (reader.read("air_index", c.air_index) && !(c.air_index > 0)) {
        reader.error(*reader.find("air_index"), "'air_index' must be greater than 0");
    }
    reader.read_word("pixel_sample", native_words<C::PixelSample>(), c.pixel_sample);
    reader.read("linear_output", c.linear_output);
    if (reader.read("max_depth", c.max_depth) && (c.max_depth < 0 || c.max_depth > 1000)) {
        reader.error(*reader.find("max_depth"), "'max_depth' must be from 0 to 1000");
    }
    if (reader.read("min_contribution", c.min_contribution) && c.min_contribution < 0) {
        reader.error(*reader.find("min_contribution"), "'min_contribution' must not be negative");
    }
    reader.finish();
}

}  // namespace alhazen
