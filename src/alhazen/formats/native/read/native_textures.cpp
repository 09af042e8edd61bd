#include "alhazen/formats/native/native_words.h"
#include "alhazen/formats/native/read/native_materials.h"

namespace alhazen {

namespace {

/// Reads `filter`, or `bilinear` in files of the first version.
void read_filter(BlockReader& reader, TextureFilter& out) {
    bool bilinear = true;
    if (reader.has("filter") && reader.has("bilinear")) {
        reader.error(reader.block(),
                     "'filter' and 'bilinear' exclude each other; expected one of them");
    }
    reader.read_word("filter", native_words<TextureFilter>(), out);
    if (reader.read("bilinear", bilinear)) {
        out = bilinear ? TextureFilter::Bilinear : TextureFilter::Nearest;
    }
}

/// Reads two rows of three numbers, a matrix that multiplies the column (u, v, 1).
void read_uv_transform(BlockReader& reader, UvTransform& out) {
    constexpr std::string_view kKey = "uv_transform";
    const auto value = reader.find(kKey);
    if (!value) return;
    if (!value->is(NodeKind::List) || value->size() != 2) {
        reader.values().fail(*value, kKey, "two rows of three numbers");
        return;
    }
    double row[2][3];
    int i = 0;
    for (const TextNode numbers : *value) {
        if (!reader.values().read_numbers(numbers, kKey, 3, row[i++])) return;
    }
    out = {row[0][0], row[0][1], row[1][0], row[1][1], {row[0][2], row[1][2]}};
}

void read_uv_set(BlockReader& reader, int& out) {
    int set = 0;
    if (!reader.read("uv_set", set)) return;
    if (set == 0 || set == 1) {
        out = set;
    } else {
        reader.error(*reader.find("uv_set"), "'uv_set' must be 0 or 1");
    }
}

}  // namespace

bool read_native_color(TextNode value, std::string_view key, const ValueReader& values, Rgb& out) {
    if (value.is(NodeKind::Number)) {
        out = {value.number(), value.number(), value.number()};
        return true;
    }
    if (value.is(NodeKind::List)) return values.read(value, key, out);
    return values.fail(value, key, "a colour (r, g, b), a number or texture(\"NAME\")");
}

void read_native_texture(const NativeBlock& block, NativeContext& context,
                         const NativeScope& scope) {
    if (!block.block) return;
    BlockReader reader = context.reader(*block.block, "texture");
    ImageTexture settings;
    settings.filter = TextureFilter::Mipmapped;
    std::string file, name = block.name;
    bool srgb = false;
    if (block.name.empty()) {
        context.diagnostics.error(block.location,
                                  "texture: expected a name, as in texture \"wood\" { }");
    }
    reader.require("file");
    const bool has_file = reader.read("file", file);
    reader.read("name", name);
    reader.read_word("wrap_u", native_words<Wrap>(), settings.wrap_u);
    reader.read_word("wrap_v", native_words<Wrap>(), settings.wrap_v);
    read_filter(reader, settings.filter);
    reader.read("corner_texels", settings.corner_texels);
    read_uv_set(reader, settings.uv_set);
    read_uv_transform(reader, settings.uv_transform);
    const bool has_srgb = reader.read("srgb", srgb);
    reader.finish();
    if (!has_file) return;
    const auto id = context.textures.load(file, scope.folder, settings, name, block.location);
    if (!id) return;
    auto& texture = std::get<ImageTexture>(context.scene.textures.back().texture);
    texture.decode_srgb = has_srgb ? srgb : !texture.image->linear;
    define_name(block.name, *id, "texture", block.location, context.texture_names,
                context.diagnostics);
}

void read_native_solid_texture(const NativeBlock& block, NativeContext& context) {
    if (!block.block) return;
    BlockReader reader = context.reader(*block.block, "solid_texture");
    if (block.name.empty()) {
        context.diagnostics.error(
            block.location, "solid_texture: expected a name, as in solid_texture \"wood\" { }");
    }
    SolidTexture solid;
    std::string name = block.name;
    reader.require("kind");
    reader.read("name", name);
    reader.read_word("kind", native_words<SolidTexture::Kind>(), solid.kind);
    const auto color = [&](std::string_view key, Rgba& out) {
        Rgb value = out.rgb();
        const auto node = reader.find(key);
        if (node && read_native_color(*node, key, reader.values(), value)) {
            out = {value.r, value.g, value.b, 1.0};
        }
    };
    color("color", solid.color);
    color("other", solid.other);
    reader.read("origin", solid.origin);
    reader.read("size", solid.size);
    reader.read("direction", solid.direction);
    reader.read("octaves", solid.octaves);
    reader.read("turbulence", solid.turbulence);
    reader.finish();
    const auto id = static_cast<TextureId>(context.scene.textures.size());
    context.scene.textures.push_back({std::move(name), solid, block.location});
    define_name(block.name, id, "texture", block.location, context.texture_names,
                context.diagnostics);
}

}  // namespace alhazen
