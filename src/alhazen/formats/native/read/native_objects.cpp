#include "alhazen/formats/native/read/native_objects.h"

#include <utility>

#include "alhazen/formats/native/native_words.h"
#include "alhazen/formats/native/read/native_materials.h"
#include "alhazen/formats/native/read/native_parts.h"
#include "alhazen/formats/native/read/native_transform.h"
#include "alhazen/formats/native/read/native_visibility.h"

namespace alhazen {

namespace {

/// Defines an object under the number that the list of objects gave its name, or the next number.
void define_object(const NativeBlock& block, ObjectDescription object, NativeContext& context) {
    auto& objects = context.scene.objects;
    const auto listed = context.listed_objects.find(block.name);
    if (listed != context.listed_objects.end()) {
        objects[static_cast<std::size_t>(context.object_names.at(block.name))] = std::move(object);
        context.listed_objects.erase(listed);
        return;
    }
    objects.push_back(std::move(object));
    const auto index = static_cast<ObjectIndex>(objects.size() - 1);
    if (block.name.empty()) return;
    define_name(block.name, index, "object", block.location, context.object_names,
                context.diagnostics);
}

void read_combination(BlockReader& reader, ObjectDescription& object) {
    reader.read_word("combine", native_words<Combine>(), object.combine);
    reader.read_word("cut_material", native_words<CutMaterial>(), object.cut_material);
}

}  // namespace

void read_native_object_list(const NativeBlock& block, NativeContext& context, NativeScope& scope) {
    if (!scope.top_level() || context.scene.objects.size() > 1 || !scope.parts.empty() ||
        !context.object_names.empty()) {
        context.diagnostics.error(block.location,
                                  "objects: belongs before the first object and part");
        return;
    }
    BlockReader reader = context.reader(*block.block, block.type);
    std::string root;
    reader.require("names");
    reader.require("root");
    const auto names = reader.find("names");
    const bool has_root = reader.read("root", root);
    std::string root_name = root;
    reader.read("root_name", root_name);
    ObjectDescription how;  // how the root combines its parts
    read_combination(reader, how);
    reader.finish();
    if (!names || !has_root || !reader.values().is_list(*names, "names")) return;
    std::vector<ObjectDescription> objects;
    for (const TextNode value : *names) {
        std::string name;
        if (!reader.values().read(value, "names", name)) continue;
        define_name(name, static_cast<ObjectIndex>(objects.size()), "object", value.location(),
                    context.object_names, context.diagnostics);
        objects.push_back({name, {}, value.location()});
        context.listed_objects.emplace(name, value.location());
    }
    if (objects.empty()) return reader.error(*names, "'names' is empty");
    const auto found = context.object_names.find(root);
    if (found == context.object_names.end()) {
        reader.error(*reader.find("root"), "'root' must be one of the names");
    } else {
        context.scene.root = found->second;
        ObjectDescription& object = objects[static_cast<std::size_t>(found->second)];
        object.name = root_name;
        object.combine = how.combine;
        object.cut_material = how.cut_material;
        context.listed_objects.erase(root);
    }
    // Done after an error too, because the names are numbered already.
    context.scene.objects = std::move(objects);
}

void read_native_object(const NativeBlock& block, NativeContext& context, NativeScope& scope) {
    if (block.name.empty()) {
        context.diagnostics.error(block.location,
                                  "object: expected a name, as in object \"chair\" { }");
    }
    BlockReader reader = context.reader(*block.block, block.type);
    ObjectDescription object{block.name, {}, block.location};
    NativeScope inner{object.parts, {}, scope.material, scope.folder, scope.nesting + 1};
    if (const auto value = reader.find("material")) {
        if (const auto id = read_material_value(*value, context)) inner.material = id;
    }
    reader.read("name", object.name);
    read_combination(reader, object);
    if (reader.read("accelerator", object.accelerator) && object.accelerator.empty()) {
        reader.error(*reader.find("accelerator"), "'accelerator' is empty: expected a name");
    }
    reader.finish(true);
    read_native_items(*block.block, context, inner);
    define_object(block, std::move(object), context);
}

void read_native_solid(const NativeBlock& block, NativeContext& context, NativeScope& scope) {
    BlockReader reader = context.reader(*block.block, block.type);
    Part part;
    part.name = block.name;
    part.location = block.location;
    read_native_placement(reader, scope, part);
    part.visible_to = scope.visible_to & read_native_visibility(reader);
    ObjectDescription object{block.name.empty() ? block.type : block.name, {}, block.location};
    for (const auto& [word, combine] : native_words<Combine>()) {
        if (word == block.type) object.combine = combine;
    }
    if (object.combine == Combine::Difference) {
        reader.read_word("cut_material", native_words<CutMaterial>(), object.cut_material);
    }
    NativeScope inner{object.parts, {}, scope.material, scope.folder, scope.nesting + 1};
    if (const auto value = reader.find("material")) {
        if (const auto id = read_material_value(*value, context)) inner.material = id;
    }
    reader.finish(true);
    read_native_items(*block.block, context, inner);
    context.count_elements(1, block.location);
    context.scene.objects.push_back(std::move(object));
    part.what = static_cast<ObjectIndex>(context.scene.objects.size() - 1);
    scope.parts.push_back(std::move(part));
}

void read_native_instance(TextNode entry, NativeContext& context, NativeScope& scope) {
    if (entry.empty() || !entry.first().is(NodeKind::String)) {
        context.diagnostics.error(entry.location(),
                                  "instance: expected the name of an object, as in instance "
                                  "\"chair\" { }");
        return;
    }
    const auto object = look_up(entry.first(), "object", context.object_names, context.diagnostics);
    Part part;
    part.object_from_part = scope.object_from_here;
    part.visible_to = scope.visible_to;
    part.location = entry.location();
    if (entry.size() == 2) {
        BlockReader reader = context.reader(*++entry.begin(), "instance");
        read_native_placement(reader, scope, part);
        part.visible_to &= read_native_visibility(reader);
        reader.read("name", part.name);
        reader.finish();
    }
    if (!object) return;
    part.what = *object;
    context.count_elements(1, part.location);
    scope.parts.push_back(std::move(part));
}

void check_listed_objects(NativeContext& context) {
    for (const auto& [name, where] : context.listed_objects) {
        context.diagnostics.error(where,
                                  "object \"" + printable(name) + "\" is listed but not defined");
    }
}

}  // namespace alhazen
