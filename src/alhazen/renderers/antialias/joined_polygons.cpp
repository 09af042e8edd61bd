#include "alhazen/renderers/antialias/joined_polygons.h"

#include <algorithm>
#include <map>
#include <utility>

#include "alhazen/primitives/primitive_columns.h"
#include "alhazen/renderers/antialias/mesh_pieces.h"

namespace alhazen {

namespace {

constexpr std::uint32_t kNoObject = ~0u;

/// Polygons that may be joined, as fans of triangles: vertices are those of the polygons.
struct PolygonGroup {
    TriangleMesh fans;
    std::vector<std::uint32_t> shapes;          ///< [polygon]
    std::vector<std::uint32_t> first_vertices;  ///< [polygon]
    double off_plane = 0;                       ///< how far surfaces lie from their corners at most

    void add(std::uint32_t shape, const Polygon& polygon, const Affine& outer_from_inner,
             double stretch) {
        const auto first = static_cast<std::uint32_t>(fans.positions.size());
        shapes.push_back(shape);
        first_vertices.push_back(first);
        for (const Vec3& v : polygon.vertices) {
            fans.positions.push_back(outer_from_inner.point(v));
        }
        const auto end = static_cast<std::uint32_t>(fans.positions.size());
        for (std::uint32_t v = first + 1; v + 1 < end; ++v) {
            fans.triangles.push_back({first, v, v + 1});
        }
        off_plane = std::max(off_plane, stretch * polygon.off_plane);
    }
};

}  // namespace

JoinedPolygons::JoinedPolygons(const PrimitiveTable& table) {
    const auto& column = std::get<ShapeColumn<Polygon>>(table.columns);
    const std::uint32_t shapes = table.first(kTriangleKind);
    objects = shapes;
    if (column.shapes.size() < 2) return;
    std::map<std::pair<MaterialId, RayMask>, PolygonGroup> groups;
    for (std::uint32_t id = 0; id < shapes; ++id) {
        const PrimitiveId shape{id};
        const std::uint32_t i = table.index(shape);
        if (table.kind(shape) >= AnalyticShapes::kCount) continue;
        with_column(table.columns, table.kind(shape), [&](const auto& c) {
            if constexpr (std::is_same_v<std::remove_cvref_t<decltype(c)>, ShapeColumn<Polygon>>) {
                const Placement* placement = table.placement_of(shape);
                const Affine map = placement != nullptr ? placement->outer_from_inner : Affine{};
                groups[{c.materials[i], table.visible_to(shape)}].add(id, c.shapes[i], map,
                                                                      stretch_bound(map.linear));
            }
        });
    }
    // [shape] the first one of its object, and the sphere around that.
    std::vector<std::uint32_t> first(shapes, kNoObject);
    std::vector<BoundingSphere> around(shapes);
    for (auto& [key, group] : groups) {
        const MeshPieces pieces(group.fans);
        std::vector<std::uint32_t> first_of_piece(pieces.pieces.size(), kNoObject);
        for (std::size_t p = 0; p < group.shapes.size(); ++p) {
            const std::uint32_t shape = group.shapes[p];
            const std::uint32_t piece = pieces.of_vertex[group.first_vertices[p]];
            std::uint32_t& of_piece = first_of_piece[piece];
            if (of_piece == kNoObject) of_piece = shape;
            first[shape] = of_piece;
            around[shape] = pieces.pieces[piece].sphere;
            around[shape].radius += group.off_plane;
        }
    }
    of_shape.resize(shapes);
    objects = 0;
    for (std::uint32_t id = 0; id < shapes; ++id) {
        if (first[id] != kNoObject && first[id] != id) {
            of_shape[id] = of_shape[first[id]];
            continue;
        }
        of_shape[id] = objects++;
        spheres.push_back(first[id] == id ? around[id] : table.sphere(id));
    }
}

}  // namespace alhazen
