// Readers of meshes, primitives and morph targets.
#include <set>

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

/// Variants are not rendered, but their description in a file must be consistent.
void check_variants(const JsonObject& primitive) {
    primitive.with_extension("KHR_materials_variants", [](const JsonObject& extension) {
        extension.require("mappings");
        std::set<Index> mapped;
        extension.each_object("mappings", [&](const JsonObject& mapping, std::size_t) {
            mapping.require("material");
            mapping.require("variants");
            (void)mapping.index("material", Collection::Materials);
            for (const Index variant : mapping.indices("variants", Collection::Variants)) {
                if (mapped.insert(variant).second) continue;
                mapping.error("variants",
                              "variant " + std::to_string(variant) + " has a material already");
            }
        });
    });
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
    check_variants(object);
    object.each_object("targets", [&](const JsonObject& target, std::size_t) {
        primitive.targets.push_back(read_attributes(target));
        if (target.keys().empty()) target.error({}, "there is no attribute");
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
