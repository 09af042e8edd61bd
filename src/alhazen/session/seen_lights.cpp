#include "alhazen/session/seen_lights.h"

#include "alhazen/base/overloaded.h"

namespace alhazen {

namespace {

std::shared_ptr<TriangleMesh> mesh_of(const MeshExtent& extent) {
    auto mesh = std::make_shared<TriangleMesh>();
    mesh->positions = extent.points;
    mesh->triangles = extent.triangles;
    return mesh;
}

MeshIndex add_mesh(SceneDescription& description, const LightDescription& light,
                   const MeshExtent& extent) {
    description.meshes.push_back({light.name, mesh_of(extent), light.location});
    return static_cast<MeshIndex>(description.meshes.size() - 1);
}

template <class S>
AnyShape prepared(S shape) {
    shape.prepare();
    return shape;
}

/// The shape of any extent but a mesh.
AnyShape surface_of(const LightExtent& extent) {
    return std::visit(Overloaded{[](const RectangleExtent& e) {
                                     Rectangle shape;
                                     shape.corner = e.corner;
                                     shape.edge_u = e.edge_u;
                                     shape.edge_v = e.edge_v;
                                     return prepared(shape);
                                 },
                                 [](const DiscExtent& e) {
                                     Disc shape;
                                     shape.center = e.center;
                                     shape.normal = e.normal;
                                     shape.radius = e.radius;
                                     shape.inner_radius = e.inner_radius;
                                     return prepared(shape);
                                 },
                                 [](const SphereExtent& e) {
                                     Sphere shape;
                                     shape.center = e.center;
                                     shape.radius = e.radius;
                                     return prepared(shape);
                                 },
                                 [](const TubeExtent& e) {
                                     Cylinder shape;
                                     shape.base = e.base;
                                     shape.top = e.top;
                                     shape.radius = e.radius;
                                     shape.capped = false;
                                     return prepared(shape);
                                 },
                                 [](const PolygonExtent& e) {
                                     Polygon shape;
                                     shape.vertices = e.vertices;
                                     return prepared(shape);
                                 },
                                 [](const MeshExtent&) { return AnyShape(); }},
                      extent);
}

/// The root, as an object to which parts can be added.
ObjectDescription& open_root(SceneDescription& description) {
    ObjectDescription& root = description.objects[static_cast<std::size_t>(description.root)];
    if (root.combine == Combine::Group && root.accelerator.empty()) return root;
    Part old;
    old.what = description.root;
    ObjectDescription around;
    around.parts.push_back(std::move(old));
    description.objects.push_back(std::move(around));
    description.root = static_cast<ObjectIndex>(description.objects.size() - 1);
    return description.objects.back();
}

}  // namespace

void add_seen_lights(SceneDescription& description) {
    for (LightDescription& light : description.lights) {
        auto* const area = std::get_if<AreaLight>(&light.light);
        if (area == nullptr || !area->seen) continue;
        area->seen = false;
        area->is_part = true;
        Part part;
        if (const auto* mesh = std::get_if<MeshExtent>(&area->extent)) {
            part.what = add_mesh(description, light, *mesh);
        } else {
            part.what = surface_of(area->extent);
        }
        Material material;
        material.name = light.name;
        material.emission.color = area->radiance;
        material.double_sided = area->two_sided;
        description.materials.push_back({std::move(material), light.location});
        part.material = static_cast<MaterialId>(description.materials.size() - 1);
        part.name = light.name;
        part.location = light.location;
        part.visible_to = kLightSurfaceMask;
        open_root(description).parts.push_back(std::move(part));
    }
}

std::optional<MaterialId> material_of_light(const SceneDescription& description,
                                            std::size_t light) {
    const auto is_part = [&](std::size_t i) {
        const auto* const area = std::get_if<AreaLight>(&description.lights[i].light);
        return area != nullptr && area->is_part;
    };
    if (!is_part(light)) return std::nullopt;
    std::size_t id = description.materials.size();
    for (std::size_t i = light; i < description.lights.size(); ++i) id -= is_part(i) ? 1 : 0;
    return static_cast<MaterialId>(id);
}

void set_surface_of_light(SceneDescription& description, std::size_t light,
                          const LightExtent& extent) {
    const std::optional<MaterialId> material = material_of_light(description, light);
    if (!material) return;
    for (ObjectDescription& object : description.objects) {
        for (Part& part : object.parts) {
            // No other part has this material.
            if (part.material != *material || std::holds_alternative<ObjectIndex>(part.what)) {
                continue;
            }
            if (const auto* mesh = std::get_if<MeshIndex>(&part.what)) {
                description.meshes[static_cast<std::size_t>(*mesh)].mesh =
                    mesh_of(std::get<MeshExtent>(extent));
            } else {
                part.what = surface_of(extent);
            }
            return;
        }
    }
}

}  // namespace alhazen
