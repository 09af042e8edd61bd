#include "alhazen/formats/native/read/native_parts.h"

#include <algorithm>
#include <memory>

#include "alhazen/formats/native/read/native_bent_polygon.h"
#include "alhazen/formats/native/read/native_cameras.h"
#include "alhazen/formats/native/read/native_height_picture.h"
#include "alhazen/formats/native/read/native_include.h"
#include "alhazen/formats/native/read/native_lights.h"
#include "alhazen/formats/native/read/native_materials.h"
#include "alhazen/formats/native/read/native_meshes.h"
#include "alhazen/formats/native/read/native_objects.h"
#include "alhazen/formats/native/read/native_patch_file.h"
#include "alhazen/formats/native/read/native_settings.h"
#include "alhazen/formats/native/read/native_shapes.h"
#include "alhazen/formats/native/read/native_transform.h"
#include "alhazen/formats/native/read/native_visibility.h"

namespace alhazen {

namespace {

Part placed_part(BlockReader& reader, const NativeBlock& block, const NativeScope& scope) {
    Part part;
    part.name = block.name;
    part.location = block.location;
    read_native_placement(reader, scope, part);
    part.visible_to = scope.visible_to & read_native_visibility(reader);
    return part;
}

void read_shape(const NativeBlock& block, NativeContext& context, NativeScope& scope) {
    BlockReader reader = context.reader(*block.block, block.type);
    Part part = placed_part(reader, block, scope);
    AnyShape shape = read_native_shape(block.type, reader);
    read_native_height_picture(reader, context, scope, shape);
    const bool complete = read_native_patch_file(reader, context, scope, block.location, shape);
    part.what = std::move(shape);
    replace_bent_polygon(context, part);
    part.material = read_part_material(reader, context, scope);
    reader.finish();
    context.count_elements(1, block.location);
    if (complete) scope.parts.push_back(std::move(part));
}

void read_mesh_part(const NativeBlock& block, NativeContext& context, NativeScope& scope) {
    BlockReader reader = context.reader(*block.block, block.type);
    Part part = placed_part(reader, block, scope);
    const std::optional<MeshIndex> mesh = read_native_mesh(reader, block, context, scope);
    part.material = read_part_material(reader, context, scope);
    reader.finish();
    if (!mesh) return;
    context.count_elements(1, block.location);
    part.what = *mesh;
    scope.parts.push_back(std::move(part));
}

// Blocks that contain parts.

void read_group(const NativeBlock& block, NativeContext& context, NativeScope& scope) {
    BlockReader reader = context.reader(*block.block, block.type);
    NativeScope inner{scope.parts,       scope.placed(read_native_transform(reader)),
                      scope.material,    scope.folder,
                      scope.nesting + 1, scope.visible_to & read_native_visibility(reader)};
    if (const auto value = reader.find("material")) {
        if (const auto id = read_material_value(*value, context)) inner.material = id;
    }
    reader.finish(true);
    read_native_items(*block.block, context, inner);
}

void read_defaults(const NativeBlock& block, NativeContext& context, NativeScope& scope) {
    BlockReader reader = context.reader(*block.block, block.type);
    if (const auto value = reader.find("material")) {
        if (const auto id = read_material_value(*value, context)) scope.material = id;
    }
    reader.finish();
}

// Dispatch of the blocks.

/// Top-level blocks other than cameras and lights.
constexpr NativeTopBlock kSettingsBlocks[] = {
    {"picture", read_picture},
    {"environment", read_environment},
    {"conventions", read_conventions},
};

using ReadPart = void (*)(const NativeBlock&, NativeContext&, NativeScope&);
constexpr std::pair<std::string_view, ReadPart> kPartBlocks[] = {
    {"geometry", read_native_geometry},
    {"mesh", read_mesh_part},
    {"group", read_group},
    {"union", read_native_solid},
    {"intersection", read_native_solid},
    {"difference", read_native_solid},
    {"objects", read_native_object_list},
    {"object", read_native_object},
    {"defaults", read_defaults},
};

/// Reads a top-level block, or reports that it is nested; false if `type` is no such block.
bool read_top_level_block(const NativeBlock& block, NativeContext& context,
                          const NativeScope& scope) {
    const auto read_one_of = [&](std::span<const NativeTopBlock> blocks) {
        for (const auto& [name, read] : blocks) {
            if (name != block.type) continue;
            if (scope.top_level()) {
                context.folder = scope.folder;
                read(block, context);
            } else {
                context.diagnostics.error(block.location,
                                          block.type + " belongs at the top level of the file");
            }
            return true;
        }
        return false;
    };
    return read_one_of(kSettingsBlocks) || read_one_of(native_camera_blocks()) ||
           read_one_of(native_light_blocks());
}

bool is_block_name(std::string_view word) {
    const std::vector<std::string_view> names = native_block_names();
    return std::find(names.begin(), names.end(), word) != names.end();
}

/// Reports `material red { }`, which is the word `material` and an entry `red`; false for all else.
bool lacks_quotes(TextNode word, TextNode next, NativeContext& context) {
    const bool named = next.is(NodeKind::Word) || (next.is(NodeKind::Entry) && !next.empty() &&
                                                   next.first().is(NodeKind::Block));
    if (!named || !word.is(NodeKind::Word) || !is_block_name(word.text()) ||
        is_block_name(next.text())) {
        return false;
    }
    context.diagnostics.error(next.location(), "names are in quotes: " + std::string(word.text()) +
                                                   " \"" + printable(next.text()) + "\"");
    return true;
}

void read_entry(TextNode entry, NativeContext& context, NativeScope& scope) {
    if (entry.text() == "include") return read_native_include(entry, context, scope);
    if (entry.text() == "instance") return read_native_instance(entry, context, scope);
    const NativeBlock block = take_apart(entry, context.diagnostics);
    if (block.block && block.block->broken()) return;
    if (read_top_level_block(block, context, scope)) return;
    if (block.type == "material") return read_native_material(block, context);
    if (block.type == "solid_texture") return read_native_solid_texture(block, context);
    if (block.type == "texture") return read_native_texture(block, context, scope);
    if (is_native_shape(block.type)) {
        if (block.block) read_shape(block, context, scope);
        return;
    }
    for (const auto& [name, read] : kPartBlocks) {
        if (name != block.type) continue;
        if (block.block) read(block, context, scope);
        return;
    }
    context.diagnostics.error(block.location, "unknown block '" + printable(block.type) +
                                                  "'; known are " + joined(native_block_names()));
}

}  // namespace

std::vector<std::string_view> native_block_names() {
    std::vector<std::string_view> names;
    for (const auto& [name, read] : kSettingsBlocks) names.push_back(name);
    for (const auto& [name, read] : native_camera_blocks()) names.push_back(name);
    for (const auto& [name, read] : native_light_blocks()) names.push_back(name);
    names.insert(names.end(), {"material", "texture", "solid_texture", "instance", "include"});
    for (const auto& [name, read] : kPartBlocks) names.push_back(name);
    for (const std::string_view name : native_shape_names()) names.push_back(name);
    return names;
}

NativeContext::NativeContext(SceneDescription& scene_, Diagnostics& diagnostics_,
                             const ImportOptions& options_)
    : scene(scene_),
      diagnostics(diagnostics_),
      options(options_),
      roots(scene_roots(options_, folder_of(scene_.path))),
      textures(scene_, diagnostics_, roots, options_.image_limits) {}

void NativeContext::count_elements(std::uint64_t more, const FileLocation& where) {
    elements += more;
    if (elements > options.max_elements) {
        throw Error(
            ErrorKind::Resource,
            "more than " + std::to_string(options.max_elements) + " vertices, triangles and parts",
            where);
    }
}

NativeBlock take_apart(TextNode entry, Diagnostics& diagnostics) {
    NativeBlock block;
    block.type = entry.text();
    block.location = entry.location();
    for (const TextNode argument : entry) {
        if (argument.is(NodeKind::String)) block.name = argument.text();
        if (argument.is(NodeKind::Block)) block.block = argument;
    }
    if (!block.block) {
        diagnostics.error(block.location, printable(block.type) + ": expected a block { }");
    }
    return block;
}

void read_native_items(TextNode block, NativeContext& context, NativeScope& scope,
                       std::size_t skip) {
    // The tree limits the nesting of each file; this limits it across included files.
    const int max_nesting = std::min(context.options.max_nesting, TextTree::kMaxNesting);
    if (scope.nesting > max_nesting) {
        context.diagnostics.error(block.location(),
                                  "blocks are nested deeper than " + std::to_string(max_nesting));
        return;
    }
    for (auto at = block.begin(); at != block.end(); ++at) {
        const TextNode item = *at;
        if (skip > 0) {
            --skip;
            continue;
        }
        if (item.broken()) continue;
        auto next = at;
        if (++next != block.end() && lacks_quotes(item, *next, context)) {
            at = next;
        } else if (item.is(NodeKind::Entry)) {
            read_entry(item, context, scope);
        } else if (item.is(NodeKind::Pair) && !scope.top_level()) {
            continue;  // already read by the group or object
        } else {
            context.diagnostics.error(
                item.location(), "expected a block such as sphere { }, found " + item.describe());
        }
    }
}

}  // namespace alhazen
