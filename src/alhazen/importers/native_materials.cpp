#include "alhazen/importers/native_materials.h"

namespace alhazen {

namespace {

/// A colour, or a number for a grey.
bool read_color_or_grey(TextNode value, std::string_view key, const ValueReader& values, Rgb& out) {
    if (value.is(NodeKind::Number)) {
        out = {value.number(), value.number(), value.number()};
        return true;
    }
    if (value.is(NodeKind::List)) return values.read(value, key, out);
    return values.fail(value, key, "a colour (r, g, b), a number or texture(\"NAME\")");
}

/// The arguments of texture("NAME") or texture("NAME", factor).
struct TextureCall {
    TextureId texture = kNoTexture;
    std::optional<TextNode> factor;
};
std::optional<TextureCall> read_texture_call(TextNode value, std::string_view key,
                                             NativeContext& context) {
    const TextNode list = value.empty() ? value : value.first();
    const std::size_t count = list.is(NodeKind::List) ? list.size() : 0;
    if (value.broken()) return std::nullopt;
    if (count < 1 || count > 2 || !list.first().is(NodeKind::String)) {
        ValueReader{context.diagnostics}.fail(value, key,
                                              "texture(\"NAME\") or texture(\"NAME\", factor)");
        return std::nullopt;
    }
    const auto id = look_up(list.first(), "texture", context.texture_names, context.diagnostics);
    if (!id) return std::nullopt;
    TextureCall call{*id, std::nullopt};
    if (count == 2) call.factor = *++list.begin();
    return call;
}

bool read_color(BlockReader& reader, std::string_view key, NativeContext& context,
                ColorInput& out) {
    const auto value = reader.find(key);
    if (!value) return false;
    if (!value->is(NodeKind::Entry, "texture")) {
        return read_color_or_grey(*value, key, reader.values(), out.color);
    }
    const auto call = read_texture_call(*value, key, context);
    if (!call) return false;
    ColorInput input{{1, 1, 1}, call->texture};
    if (call->factor && !read_color_or_grey(*call->factor, key, reader.values(), input.color)) {
        return false;
    }
    out = input;
    return true;
}

void read_scalar(BlockReader& reader, std::string_view key, NativeContext& context,
                 ScalarInput& out) {
    const auto value = reader.find(key);
    if (!value) return;
    if (!value->is(NodeKind::Entry, "texture")) {
        reader.values().read(*value, key, out.value);
        return;
    }
    const auto call = read_texture_call(*value, key, context);
    if (!call) return;
    ScalarInput input{1, call->texture};
    if (call->factor) reader.values().read(*call->factor, key, input.value);
    out = input;
}

MaterialId add_material(TextNode block, std::string name, NativeContext& context) {
    BlockReader reader = context.reader(block, "material");
    Material m;
    m.name = std::move(name);
    read_color(reader, "emission", context, m.emission);
    const bool has_ambient = reader.has("ambient");
    read_color(reader, "ambient", context, m.ambient);
    read_color(reader, "diffuse", context, m.diffuse);
    read_color(reader, "specular", context, m.specular);
    read_color(reader, "reflective", context, m.reflective);
    read_color(reader, "transmissive", context, m.transmissive);
    read_scalar(reader, "shininess", context, m.shininess);
    read_scalar(reader, "index", context, m.index);
    if (!has_ambient) m.ambient = m.diffuse;
    reader.finish();
    context.scene.materials.push_back({std::move(m), block.location()});
    return static_cast<MaterialId>(context.scene.materials.size() - 1);
}

/// What parts are made of when the file says nothing: a matt grey.
MaterialId built_in_material(NativeContext& context) {
    if (!context.built_in_material) {
        Material grey;
        grey.name = "default";
        grey.diffuse.color = grey.ambient.color = {0.7, 0.7, 0.7};
        context.scene.materials.push_back({grey, {}});
        context.built_in_material = static_cast<MaterialId>(context.scene.materials.size() - 1);
    }
    return *context.built_in_material;
}

}  // namespace

void read_native_material(const NativeBlock& block, NativeContext& context) {
    if (!block.block) return;
    if (block.name.empty()) {
        context.diagnostics.error(block.location,
                                  "material: expected a name, as in material \"red\" { }");
    }
    const MaterialId id = add_material(*block.block, block.name, context);
    if (!block.name.empty()) {
        define_name(block.name, id, "material", block.location, context.material_names,
                    context.diagnostics);
    }
}

void read_native_texture(const NativeBlock& block, NativeContext& context,
                         const NativeScope& scope) {
    if (!block.block) return;
    static const Vocabulary<Wrap> kWraps{
        {"repeat", Wrap::Repeat}, {"clamp", Wrap::Clamp}, {"mirror", Wrap::Mirror}};
    BlockReader reader = context.reader(*block.block, "texture");
    Texture settings;
    std::string file;
    bool srgb = false;
    if (block.name.empty()) {
        context.diagnostics.error(block.location,
                                  "texture: expected a name, as in texture \"wood\" { }");
    }
    reader.require("file");
    const bool has_file = reader.read("file", file);
    reader.read_word("wrap_u", kWraps, settings.wrap_u);
    reader.read_word("wrap_v", kWraps, settings.wrap_v);
    bool bilinear = true;
    if (reader.read("bilinear", bilinear) && !bilinear) settings.filter = TextureFilter::Nearest;
    reader.read("corner_texels", settings.corner_texels);
    const bool has_srgb = reader.read("srgb", srgb);
    reader.finish();
    if (!has_file) return;
    const auto id = context.textures.load(file, scope.folder, settings, block.name, block.location);
    if (!id) return;
    Texture& texture = context.scene.textures.back().texture;
    texture.decode_srgb = has_srgb ? srgb : !texture.image->linear;
    define_name(block.name, *id, "texture", block.location, context.texture_names,
                context.diagnostics);
}

std::optional<MaterialId> read_material_value(TextNode value, NativeContext& context) {
    if (value.broken()) return std::nullopt;
    if (value.is(NodeKind::Block)) return add_material(value, "", context);
    if (value.is(NodeKind::String) || value.is(NodeKind::Word)) {
        return look_up(value, "material", context.material_names, context.diagnostics);
    }
    ValueReader{context.diagnostics}.fail(value, "material",
                                          "the name of a material or a block { }");
    return std::nullopt;
}

MaterialId read_part_material(BlockReader& reader, NativeContext& context,
                              const NativeScope& scope) {
    std::optional<MaterialId> id;
    if (const auto value = reader.find("material")) id = read_material_value(*value, context);
    if (!id) id = scope.material;
    return id ? *id : built_in_material(context);
}

}  // namespace alhazen
