#include "alhazen/formats/native/read/native_bent_polygon.h"

#include <memory>

#include "alhazen/formats/mesh/bent_polygon.h"

namespace alhazen {

namespace {

std::shared_ptr<TriangleMesh> mesh_of(const BentPolygon& bent) {
    const Polygon& polygon = bent.polygon;
    auto mesh = std::make_shared<TriangleMesh>();
    mesh->positions = polygon.vertices;
    const Vec3 v_axis = cross(polygon.normal, polygon.u_axis);
    for (const Vec3& p : polygon.vertices) {
        const Vec3 offset = p - polygon.vertices.front();
        mesh->uvs.push_back({dot(offset, polygon.u_axis), dot(offset, v_axis)});
    }
    mesh->triangles = bent.triangles();
    return mesh;
}

}  // namespace

void replace_bent_polygon(NativeContext& context, Part& part) {
    const auto* shape = std::get_if<AnyShape>(&part.what);
    const auto* given = shape != nullptr ? std::get_if<Polygon>(shape) : nullptr;
    if (given == nullptr) return;
    const auto bent = bent_polygon(*given);
    if (!bent) return;
    context.diagnostics.warning(
        part.location,
        "polygon: " + bent->warning() +
            (bent->is_simple ? "read as triangles"
                             : "met in their mean plane, and as a light not sampled"));
    if (!bent->is_simple) return;
    auto mesh = mesh_of(*bent);
    context.count_elements(mesh->positions.size() + mesh->triangles.size(), part.location);
    context.scene.meshes.push_back({part.name, std::move(mesh), part.location, {}, true});
    part.what = static_cast<MeshIndex>(context.scene.meshes.size() - 1);
}

void replace_bent_polygon(NativeContext& context, const FileLocation& where, LightExtent& extent) {
    const auto* given = std::get_if<PolygonExtent>(&extent);
    if (given == nullptr) return;
    Polygon polygon;
    polygon.vertices = given->vertices;
    const auto bent = bent_polygon(polygon);
    if (!bent) return;
    context.diagnostics.warning(where, "polygon_light: " + bent->warning() +
                                           (bent->is_simple ? "read as triangles"
                                                            : "read as a polygon in their mean "
                                                              "plane"));
    if (bent->is_simple) {
        extent = MeshExtent{bent->polygon.vertices, bent->triangles()};
    } else {
        extent = PolygonExtent{bent->flat};
    }
}

}  // namespace alhazen
