#include "alhazen/formats/ray/ray_materials.h"

#include <algorithm>

#include "alhazen/formats/ray/ray_extensions.h"
#include "alhazen/formats/text/first_names.h"

namespace alhazen {

namespace {

/// Factor of a `shininess = map(...)`, whose texture holds 0..1 in both families.
constexpr double kShininessMapScale = 128.0;

/// The image folder, since the courses keep scenes in its subfolders.
std::filesystem::path default_root(const std::filesystem::path& scene_folder) {
    return scene_folder.parent_path();
}

}  // namespace

RayMaterials::RayMaterials(RayContext& context)
    : context_(context),
      folder_(folder_of(context.scene.path)),
      textures_(context.scene, context.diagnostics,
                scene_roots(context.options, default_root(folder_)), context.options.image_limits),
      finder_(scene_roots(context.options, default_root(folder_)), folder_) {}

RayMaterial RayMaterials::read(TextNode value, const RayMaterial& enclosing) {
    if (value.broken()) return enclosing;
    if (value.is(NodeKind::Block)) return read_block(value, enclosing);
    if (value.is(NodeKind::Word) || value.is(NodeKind::String)) return named(value, enclosing);
    ValueReader{context_.diagnostics}.fail(value, "material",
                                           "a block { } or the name of a material");
    return enclosing;
}

void RayMaterials::define(TextNode entry, const RayMaterial& enclosing) {
    if (entry.empty() || !entry.first().is(NodeKind::Block)) {
        context_.diagnostics.error(entry.location(), "material: expected '= ...' or a block { }");
        return;
    }
    const RayMaterial made = read_block(entry.first(), enclosing);
    if (made.value.name.empty()) {
        context_.diagnostics.warning(entry.location(),
                                     "material: a definition without a name has no effect");
    }
}

RayMaterial RayMaterials::named(TextNode word, const RayMaterial& fallback) {
    const auto found = by_name_.find(std::string(word.text()));
    if (found != by_name_.end()) return found->second;
    context_.diagnostics.error(
        word.location(), "material '" + printable(word.text()) + "' is not defined" +
                             (by_name_.empty() ? "" : "; defined are " + first_names(by_name_)));
    return fallback;
}

RayMaterial RayMaterials::read_block(TextNode block, const RayMaterial& enclosing) {
    BlockReader reader(block, "material", BlockReader::Strictness::Tolerant, context_.diagnostics);
    RayMaterial made{enclosing.value, std::nullopt, block.location()};
    Material& m = made.value;
    read_color(reader, "emissive", m.emission);
    read_color(reader, "ambient", m.ambient);
    read_color(reader, "diffuse", m.diffuse);
    read_color(reader, "specular", m.specular);
    read_color(reader, "reflective", m.reflective);      // kr of the equation
    read_color(reader, "transmissive", m.transmissive);  // kt
    read_scalar(reader, "shininess", context_.family.shininess_scale, kShininessMapScale,
                m.shininess);
    read_scalar(reader, "index", 1.0, 1.0, m.index);
    // Both families: specular surfaces also reflect, unless the block sets `reflective`.
    if (reader.has("specular") && !reader.has("reflective")) m.reflective = m.specular;
    m.name = read_name(reader);
    refuse_extensions(reader);
    reader.finish(true);
    if (!m.name.empty()) add_name(m.name, made);
    return made;
}

std::string RayMaterials::read_name(BlockReader& reader) {
    std::string name;
    reader.read("name", name);
    for (const TextNode item : reader.block()) {
        if (item.broken() || item.is(NodeKind::Pair)) continue;
        if (item.is(NodeKind::Entry, "name") && !item.empty()) {
            reader.values().read(item.first(), "name", name);  // `name red;`
        } else if (const auto extension = ray_material_extension(item.text())) {
            reader.error(item, refusal("material key", item.text(), *extension));
        } else {
            context_.diagnostics.warning(item.location(),
                                         "material: unexpected " + item.describe());
        }
    }
    return name;
}

void RayMaterials::refuse_extensions(BlockReader& reader) {
    for (const TextNode item : reader.block()) {
        if (!item.is(NodeKind::Pair)) continue;
        if (const auto extension = ray_material_extension(item.text())) {
            reader.ignore(item.text());
            reader.error(item, refusal("material key", item.text(), *extension));
        }
    }
}

void RayMaterials::add_name(const std::string& name, RayMaterial& material) {
    const auto found = by_name_.find(name);
    if (found != by_name_.end()) {
        context_.diagnostics.error(
            material.location, "material '" + printable(name) + "' is already defined in line " +
                                   std::to_string(found->second.location.line));
        return;
    }
    use(material);  // one material of the scene for all references
    by_name_.emplace(name, material);
}

MaterialId RayMaterials::use(RayMaterial& material) {
    if (!material.id) {
        context_.scene.materials.push_back({material.value, material.location});
        material.id = static_cast<MaterialId>(context_.scene.materials.size() - 1);
    }
    return *material.id;
}

std::optional<TextureId> RayMaterials::read_map(TextNode value, std::string_view key) {
    std::string file;
    const TextNode list = value.empty() ? value : value.first();
    if (!list.is(NodeKind::List) || list.size() != 1) {
        context_.diagnostics.error(value.location(), std::string(key) + ": expected map(\"FILE\")");
        return std::nullopt;
    }
    if (!ValueReader{context_.diagnostics}.read(list.first(), "map", file)) return std::nullopt;
    const auto known = maps_.find(file);
    if (known != maps_.end()) return known->second;
    // Coordinates are in [0, 1]; clamping prevents bleeding between opposite edges.
    ImageTexture settings;
    settings.wrap_u = settings.wrap_v = Wrap::Clamp;
    const auto id = textures_.load(finder_.find(file).value_or(file), folder_, settings, file,
                                   list.first().location());
    if (id) maps_.emplace(file, *id);
    return id;
}

void RayMaterials::read_color(BlockReader& reader, std::string_view key, ColorInput& out) {
    const std::optional<TextNode> value = reader.find(key);
    if (!value || value->broken()) return;
    if (value->is(NodeKind::Entry, "map")) {
        if (const auto texture = read_map(*value, key)) out = {{1, 1, 1}, *texture};
    } else if (value->is(NodeKind::List)) {
        Rgb color;
        if (!reader.values().read(*value, key, color)) return;
        if (key == "emissive" && std::min({color.r, color.g, color.b}) < 0) {
            reader.error(*value, "emissive must not be negative");
        } else {
            out = {color, kNoTexture};
        }
    } else {
        reader.values().fail(*value, key, "a colour (r, g, b) or map(\"FILE\")");
    }
}

void RayMaterials::read_scalar(BlockReader& reader, std::string_view key, double scale,
                               double map_scale, ScalarInput& out) {
    const std::optional<TextNode> value = reader.find(key);
    if (!value || value->broken()) return;
    if (value->is(NodeKind::Entry, "map")) {
        if (const auto texture = read_map(*value, key)) out = {map_scale, *texture};
    } else if (value->is(NodeKind::Number)) {
        if (value->number() >= 0) {
            out = {value->number() * scale, kNoTexture};
        } else {
            reader.error(*value, std::string(key) + " must not be negative");
        }
    } else {
        reader.values().fail(*value, key, "a number or map(\"FILE\")");
    }
}

}  // namespace alhazen
