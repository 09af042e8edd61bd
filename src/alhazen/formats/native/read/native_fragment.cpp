#include "alhazen/formats/native/read/native_fragment.h"

#include <utility>

#include "alhazen/formats/native/read/native_cameras.h"
#include "alhazen/formats/native/read/native_objects.h"
#include "alhazen/formats/native/read/native_parts.h"

namespace alhazen {

namespace {

/// Enters the named items of a scene into `names`.
template <class Things, class Id, class NameOf>
void know_names(const Things& things, std::map<std::string, Id, std::less<>>& names,
                NameOf name_of) {
    for (std::size_t i = 0; i < things.size(); ++i) {
        const std::string& name = name_of(things[i]);
        if (!name.empty()) names.emplace(name, static_cast<Id>(i));
    }
}

}  // namespace

void read_native_fragment(std::string_view text, const std::string& name,
                          const ImportOptions& options, SceneDescription& scene,
                          Diagnostics& diagnostics) {
    const SourceText source(text, name);
    const TextTree tree(source,
                        {.max_nesting = options.max_nesting,
                         .max_nodes = options.max_elements,
                         .string_escapes = true},
                        diagnostics);
    NativeContext context(scene, diagnostics, options);
    const auto own_name = [](const auto& thing) -> const std::string& { return thing.name; };
    know_names(scene.materials, context.material_names,
               [](const MaterialDescription& m) -> const std::string& { return m.material.name; });
    know_names(scene.textures, context.texture_names, own_name);
    know_names(scene.meshes, context.geometry_names, own_name);
    know_names(scene.objects, context.object_names, own_name);
    const auto root = static_cast<std::size_t>(scene.root);
    std::vector<Part> parts = std::move(scene.objects[root].parts);
    scene.objects[root].parts.clear();
    NativeScope scope{parts, {}, std::nullopt, folder_of(scene.path)};
    read_native_items(tree.root(), context, scope);
    scene.objects[static_cast<std::size_t>(scene.root)].parts = std::move(parts);
    check_listed_objects(context);
    complete_cameras(context);
    open_shutter(scene, scene.shutter);
}

}  // namespace alhazen
