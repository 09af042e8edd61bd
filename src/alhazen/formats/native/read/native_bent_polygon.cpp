#include "alhazen/formats/native/read/native_bent_polygon.h"

#include <algorithm>
#include <memory>
#include <numeric>
#include <vector>

#include "alhazen/base/number_text.h"
#include "alhazen/geometry/polygon/polygon_plane.h"
#include "alhazen/geometry/polygon/triangulate.h"
#include "alhazen/geometry/repair/repaired_polygon.h"
#include "alhazen/shapes/core/shape_numerics.h"
#include "alhazen/shapes/polygons/flat_vertices.h"

namespace alhazen {

namespace {

/// True if the numbers can be computed with; others are reported by the validation.
bool is_complete(const Polygon& polygon) {
    return polygon.vertices.size() > 3 && std::ranges::all_of(polygon.vertices, [](const Vec3& p) {
               return is_finite(p) && max_component(abs(p)) <= kMaxCoordinate;
           });
}

/// Drops corners of a single loop that are where the one before is.
void drop_repeated(Polygon& polygon) {
    std::vector<Vec3>& v = polygon.vertices;
    if (polygon.loop_ends.size() > 1) return;
    v.erase(std::unique(v.begin(), v.end()), v.end());
    while (v.size() > 1 && v.back() == v.front()) v.pop_back();
    polygon.loop_ends.clear();
}

std::shared_ptr<TriangleMesh> triangles_of(const Polygon& polygon, const std::vector<Vec3>& flat) {
    auto mesh = std::make_shared<TriangleMesh>();
    mesh->positions = polygon.vertices;
    const Vec3 v_axis = cross(polygon.normal, polygon.u_axis);
    for (const Vec3& p : polygon.vertices) {
        const Vec3 offset = p - polygon.vertices.front();
        mesh->uvs.push_back({dot(offset, polygon.u_axis), dot(offset, v_axis)});
    }
    std::vector<std::uint32_t> loop(polygon.vertices.size());
    std::iota(loop.begin(), loop.end(), 0u);
    triangulate(flat, loop, mesh->triangles);
    return mesh;
}

/// True if triangles on the corners are certain to cover what is inside the loop, seen along the
/// normal.
bool is_simple(const Polygon& polygon, const std::vector<Vec3>& flat) {
    if (polygon.loop_ends.size() > 1) return false;
    const RepairedPolygon repaired = repaired_polygon(
        flat, polygon.loop_ends, {polygon.normal, dot(polygon.normal, polygon.point)});
    return !repaired.crosses && repaired.refused.empty();
}

}  // namespace

void replace_bent_polygon(NativeContext& context, Part& part) {
    const auto* shape = std::get_if<AnyShape>(&part.what);
    const auto* given = shape != nullptr ? std::get_if<Polygon>(shape) : nullptr;
    if (given == nullptr || !is_complete(*given)) return;
    Polygon polygon = *given;
    drop_repeated(polygon);
    if (!is_complete(polygon)) return;
    polygon.prepare();
    if (is_flat(polygon.vertices, polygon.normal)) return;
    const std::vector<Vec3> flat = flat_vertices(polygon);
    const bool is_mesh = is_simple(polygon, flat);
    context.diagnostics.warning(
        part.location, "polygon: its corners are not in a plane, but up to " +
                           shortest(polygon.off_plane) + " off: it is " +
                           (is_mesh ? "read as triangles"
                                    : "met in their mean plane, and as a light not sampled"));
    if (!is_mesh) return;
    auto mesh = triangles_of(polygon, flat);
    context.count_elements(mesh->positions.size() + mesh->triangles.size(), part.location);
    context.scene.meshes.push_back({part.name, std::move(mesh), part.location, {}, true});
    part.what = static_cast<MeshIndex>(context.scene.meshes.size() - 1);
}

}  // namespace alhazen
