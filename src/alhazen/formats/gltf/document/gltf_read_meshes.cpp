// Readers of meshes, primitives and morph targets.
#include "alhazen/formats/gltf/document/gltf_readers.h"

namespace alhazen::gltf {

namespace {

Attributes read_attributes(const JsonObject& object) {
    Attributes attributes;
    for (const std::string& name : object.keys()) {
        if (name == "extensions" || name == "extras") continue;
        const auto accessor = object.index(name, Collection::Accessors);
        if (accessor) attributes[name] = *accessor;
    }
    return attributes;
}

Primitive read_primitive(const JsonObject& object) {
    Primitive primitive;
    object.require("attributes");
    object.with_object("attributes", [&](const JsonObject& attributes) {
        primitive.attributes = read_attributes(attributes);
        if (attributes.keys().empty()) attributes.error({}, "there is no attribute");
    });
    primitive.indices = object.index("indices", Collection::Accessors);
    primitive.material = object.index("material", Collection::Materials);
    if (const auto mode = object.integer("mode"); mode && *mode > 6) {
        object.warning("mode", "expected 0 to 6; taken as 4 (triangles)");
    } else if (mode) {
        primitive.mode = static_cast<PrimitiveMode>(*mode);
    }
    object.each_object("targets", [&](const JsonObject& target, std::size_t) {
        primitive.targets.push_back(read_attributes(target));
    });
    return primitive;
}

Mesh read_mesh(const JsonObject& object) {
    Mesh mesh;
    mesh.name = object.text("name").value_or("");
    object.require("primitives");
    object.each_object("primitives", [&](const JsonObject& primitive, std::size_t) {
        mesh.primitives.push_back(read_primitive(primitive));
    });
    mesh.weights = object.numbers("weights", 0).value_or(std::vector<double>());
    return mesh;
}

}  // namespace

void read_meshes(const JsonObject& root, Loading& loading) {
    root.each_object("meshes", [&](const JsonObject& object, std::size_t) {
        loading.document.meshes.push_back(read_mesh(object));
    });
}

}  // namespace alhazen::gltf
