#include "alhazen/aggregates/wide_bvh/table_fingerprint.h"

#include "alhazen/aggregates/wide_bvh/leaves/flat_shapes.h"
#include "alhazen/aggregates/wide_bvh/leaves/leaf_bounds.h"
#include "alhazen/base/checksum.h"

namespace alhazen {
namespace {

void add(Checksum& sum, const Vec3& v) {
    for (int k = 0; k < 3; ++k) sum.add(v[k]);
}
void add(Checksum& sum, const Box3& box) {
    add(sum, box.lo);
    add(sum, box.hi);
}

/// Adds the bounding body of a primitive in its leaf, except for spheres.
void add_body(Checksum& sum, const PrimitiveTable& table, PrimitiveId id) {
    const LeafType leaf = leaf_type(table, id);
    sum.add(static_cast<std::uint64_t>(leaf));
    if (leaf == LeafType::Frustums) {
        const RoundBounds bounds = round_bounds(table, id);
        add(sum, bounds.center);
        add(sum, bounds.axis);
        for (const double x : {bounds.half_height, bounds.radius, bounds.slope}) sum.add(x);
    } else if (leaf == LeafType::Others && table.box(static_cast<std::uint32_t>(id)).bounded()) {
        const SlantedBounds bounds = slanted_bounds(table, id);
        add(sum, bounds.corner);
        for (const Vec3& edge : bounds.edge) add(sum, edge);
        const BoundingSphere sphere = table.sphere(static_cast<std::size_t>(id));
        add(sum, sphere.center);
        sum.add(sphere.radius);
        // What is surely within an outline depends on all of it.
        const FlatOutline outline = flat_outline(table, id);
        sum.add(std::span<const Vec3>(outline.vertices));
        sum.add(std::span<const std::uint32_t>(outline.loop_ends));
    }
}

void add_meshes(Checksum& sum, const PrimitiveTable& table) {
    static_assert(sizeof(Vec3) == 3 * sizeof(double) &&
                  sizeof(table.meshes[0].mesh->triangles[0]) == 12);
    for (const PlacedMesh& placed : table.meshes) {
        const TriangleMesh& mesh = *placed.mesh;
        sum.add(std::span(mesh.positions));
        sum.add(std::span(mesh.triangles));
        const std::uint32_t first = table.first(kTriangleKind) + placed.first_triangle;
        // One value for the whole mesh if its vertices have no materials.
        const std::size_t answers = mesh.vertex_materials.empty()
                                        ? std::min<std::size_t>(1, mesh.triangles.size())
                                        : mesh.triangles.size();
        for (std::uint32_t i = 0; i < answers; ++i) {
            sum.add(std::uint64_t{table.is_opaque(PrimitiveId{first + i})});
        }
    }
}

}  // namespace

std::uint64_t table_fingerprint(const PrimitiveTable& table) {
    Checksum sum;
    for (std::uint32_t kind = 0; kind <= kKindCount; ++kind) {
        sum.add(std::uint64_t{table.first(kind)});
    }
    // Analytic shapes and instances: their boxes do not determine the bodies in the leaves.
    const auto add_boxes = [&](std::uint32_t begin, std::uint32_t end) {
        for (std::uint32_t i = begin; i < end; ++i) {
            add(sum, table.box(i));
            sum.add(std::uint64_t{table.is_opaque(PrimitiveId{i})});
            add_body(sum, table, PrimitiveId{i});
        }
    };
    add_boxes(0, table.first(kTriangleKind));
    add_boxes(table.first(kInstanceKind), table.first(kInstanceKind + 1));
    const auto& spheres = std::get<ShapeColumn<Sphere>>(table.columns);
    for (std::size_t i = 0; i < spheres.shapes.size(); ++i) {
        add(sum, spheres.shapes[i].center);
        sum.add(spheres.shapes[i].radius);
        sum.add(std::uint64_t{spheres.placements[i] == kNoPlacement});
    }
    add_meshes(sum, table);
    return sum.value();
}

}  // namespace alhazen
