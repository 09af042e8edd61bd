#include "alhazen/formats/native/write/native_writer.h"

#include "alhazen/formats/core/default_conventions.h"
#include "alhazen/formats/native/write/native_write_context.h"
#include "alhazen/formats/text/unique_labels.h"

namespace alhazen {

namespace {

template <class Things, class NameOf>
std::vector<std::string> labels_of(const Things& things, const char* kind, NameOf name_of) {
    std::vector<std::string> names;
    names.reserve(things.size());
    for (const auto& thing : things) names.push_back(name_of(thing));
    return unique_labels(names, kind);
}

}  // namespace

std::string native_scene_text(const SceneDescription& description, const std::string& folder,
                              const NativeFileSink& write_beside) {
    NativeWriteContext context{description, folder, write_beside};
    const auto own_name = [](const auto& thing) { return thing.name; };
    context.material_labels =
        labels_of(description.materials, "material", [](const auto& m) { return m.material.name; });
    context.texture_labels = labels_of(description.textures, "texture", own_name);
    context.geometry_labels = labels_of(description.meshes, "geometry", own_name);
    context.object_labels = labels_of(description.objects, "object", own_name);
    context.text = "alhazen 1\n\n";
    write_native_picture(context);
    write_native_environment(context);
    write_native_conventions(context);
    write_native_cameras(context);
    write_native_lights(context);
    write_native_textures(context);
    write_native_materials(context);
    write_native_geometries(context);
    write_native_objects(context);
    return std::move(context.text);
}

}  // namespace alhazen
