#include "alhazen/renderers/antialias/joined_polygons.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <span>
#include <unordered_map>
#include <utility>

#include "alhazen/base/disjoint_sets.h"
#include "alhazen/primitives/primitive_columns.h"
#include "alhazen/renderers/antialias/mesh_pieces.h"

namespace alhazen {

namespace {

constexpr std::uint32_t kNoObject = ~0u;

/// Polygons that may be joined.
struct PolygonGroup {
    std::vector<Vec3> positions;                  ///< corners of the polygons, polygon by polygon
    std::vector<std::uint32_t> shapes;            ///< [polygon]
    std::vector<std::uint32_t> first_corners{0};  ///< [polygon], and the number of corners
    double off_plane = 0;  ///< bound of the distance of surfaces from the plane of their corners

    void add(std::uint32_t shape, const Polygon& polygon, const Affine& outer_from_inner,
             double stretch) {
        shapes.push_back(shape);
        for (const Vec3& v : polygon.vertices) positions.push_back(outer_from_inner.point(v));
        first_corners.push_back(static_cast<std::uint32_t>(positions.size()));
        off_plane = std::max(off_plane, stretch * polygon.off_plane);
    }
    [[nodiscard]] std::span<const Vec3> corners(std::size_t polygon) const {
        return std::span(positions).subspan(first_corners[polygon],
                                            first_corners[polygon + 1] - first_corners[polygon]);
    }
};

/// The polygons that are connected by common sides.
DisjointSets connected(const PolygonGroup& group) {
    const std::vector<std::uint32_t> places = first_of_position(group.positions);
    std::vector<std::uint32_t> alone(group.shapes.size());
    std::iota(alone.begin(), alone.end(), 0u);
    DisjointSets sets(std::move(alone));
    std::unordered_map<std::uint64_t, std::uint32_t> of_side;
    for (std::uint32_t p = 0; p < group.shapes.size(); ++p) {
        const std::uint32_t end = group.first_corners[p + 1];
        std::uint32_t from = places[end - 1];
        for (std::uint32_t v = group.first_corners[p]; v < end; ++v) {
            const std::uint32_t to = places[v];
            const std::uint64_t side = std::uint64_t{std::min(from, to)} << 32 | std::max(from, to);
            const auto [first, is_new] = of_side.try_emplace(side, p);
            if (!is_new) sets.unite(first->second, p);
            from = to;
        }
    }
    return sets;
}

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
    // [shape] the first shape of its object, and the sphere around that object.
    std::vector<std::uint32_t> first(shapes, kNoObject);
    std::vector<BoundingSphere> around(shapes);
    for (auto& [key, group] : groups) {
        DisjointSets sets = connected(group);
        const auto count = static_cast<std::uint32_t>(group.shapes.size());
        std::vector<Box3> boxes(count);
        for (std::uint32_t p = 0; p < count; ++p) {
            for (const Vec3& v : group.corners(p)) boxes[sets.find(p)].include(v);
        }
        for (std::uint32_t p = 0; p < count; ++p) {
            const std::uint32_t root = sets.find(p);
            const std::uint32_t shape = group.shapes[root];
            first[group.shapes[p]] = shape;
            BoundingSphere& sphere = around[shape];
            sphere.center = boxes[root].center();
            for (const Vec3& v : group.corners(p)) {
                sphere.radius = std::max(
                    sphere.radius, (1.0 + 1e-15) * length(v - sphere.center) + group.off_plane);
            }
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
