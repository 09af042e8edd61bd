#include "alhazen/shading/lights/extent_triangles.h"

#include "alhazen/geometry/polygon/polygon_plane.h"
#include "alhazen/geometry/polygon/triangulate.h"
#include "alhazen/geometry/repair/repaired_polygon.h"
#include "alhazen/math/unit_vector.h"

namespace alhazen {

namespace {

void append_loop(const std::vector<Vec3>& loop, MeshExtent& mesh) {
    std::vector<std::uint32_t> indices;
    for (const Vec3& p : loop) {
        indices.push_back(static_cast<std::uint32_t>(mesh.points.size()));
        mesh.points.push_back(p);
    }
    triangulate(mesh.points, indices, mesh.triangles);
}

}  // namespace

MeshExtent triangles_of(const PolygonExtent& polygon) {
    const std::vector<Vec3>& corners = polygon.vertices;
    MeshExtent mesh;
    if (corners.size() > 3) {
        const Vec3 normal = unit_or(plane_normal_of_loops(corners, {}), {0, 0, 1});
        Vec3 sum;
        for (const Vec3& p : corners) sum += p - corners[0];
        const Vec3 middle = corners[0] + sum / static_cast<double>(corners.size());
        const RepairedPolygon repaired =
            repaired_polygon(corners, {}, {normal, dot(normal, middle)});
        if (repaired.crosses) {
            for (const std::vector<Vec3>& part : repaired.parts) append_loop(part, mesh);
            return mesh;
        }
    }
    append_loop(corners, mesh);
    return mesh;
}

}  // namespace alhazen
