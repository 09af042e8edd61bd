#include "alhazen/tracer/tracer_scene.h"

#include <utility>

#include "alhazen/base/diagnostics.h"
#include "alhazen/base/error.h"
#include "alhazen/tracer/tracer.h"

namespace alhazen {
namespace {

/// The location of a finding about `geometry`.
FileLocation place_of(std::uint32_t geometry) {
    return {"geometry " + std::to_string(geometry), 0, 0};
}

void check_transform(const Affine& transform, std::uint32_t geometry) {
    if (is_invertible(transform)) return;
    throw Error(ErrorKind::Scene, "the transform is singular or not finite", place_of(geometry));
}

/// Checks a mesh or an analytic shape.
template <class Shape>
void check_shape(const Shape& shape, std::uint32_t geometry) {
    Diagnostics diagnostics;
    shape.validate(place_of(geometry), diagnostics);
    diagnostics.throw_if_errors();
}

}  // namespace

GeometryId TracerScene::add_mesh(std::span<const Vec3> positions,
                                 std::span<const std::array<std::uint32_t, 3>> triangles,
                                 const GeometryOptions& options) {
    TriangleMesh mesh;
    mesh.positions.assign(positions.begin(), positions.end());
    mesh.triangles.assign(triangles.begin(), triangles.end());
    return add_mesh(std::make_shared<const TriangleMesh>(std::move(mesh)), options);
}

GeometryId TracerScene::add_mesh(std::span<const float> coordinates,
                                 std::span<const std::uint32_t> indices,
                                 const GeometryOptions& options) {
    const auto check = [&](std::size_t length, const char* what) {
        if (length % 3 == 0) return;
        throw Error(ErrorKind::Usage,
                    std::to_string(length) + " " + what + " given, expected three for each " +
                        (what[0] == 'c' ? "vertex" : "triangle"),
                    place_of(count_));
    };
    check(coordinates.size(), "coordinates");
    check(indices.size(), "indices");
    TriangleMesh mesh;
    mesh.positions.reserve(coordinates.size() / 3);
    for (std::size_t i = 0; i < coordinates.size(); i += 3) {
        mesh.positions.push_back({coordinates[i], coordinates[i + 1], coordinates[i + 2]});
    }
    mesh.triangles.reserve(indices.size() / 3);
    for (std::size_t i = 0; i < indices.size(); i += 3) {
        mesh.triangles.push_back({indices[i], indices[i + 1], indices[i + 2]});
    }
    return add_mesh(std::make_shared<const TriangleMesh>(std::move(mesh)), options);
}

GeometryId TracerScene::add_mesh(std::shared_ptr<const TriangleMesh> mesh,
                                 const GeometryOptions& options) {
    if (!mesh) throw Error(ErrorKind::Usage, "the mesh is a null pointer", place_of(count_));
    if (!mesh->vertex_materials.empty()) {
        throw Error(ErrorKind::Usage, "the mesh has vertex materials; expected none",
                    place_of(count_));
    }
    const Affine& transform = options.world_from_geometry;
    check_transform(transform, count_);
    check_shape(*mesh, count_);
    if (transform == Affine{}) return place_mesh(std::move(mesh), false, options.visible_to);
    TriangleMesh moved = *mesh;
    moved.transform(transform);
    check_shape(moved, count_);
    return place_mesh(std::make_shared<const TriangleMesh>(std::move(moved)),
                      determinant(transform.linear) < 0.0, options.visible_to);
}

GeometryId TracerScene::place_mesh(std::shared_ptr<const TriangleMesh> mesh, bool mirrored,
                                   RayMask visible_to) {
    table_.meshes.push_back({std::move(mesh), MaterialId{0}, 0, mirrored, count_, visible_to});
    return GeometryId{count_++};
}

GeometryId TracerScene::add_sphere(const Vec3& center, double radius,
                                   const GeometryOptions& options) {
    return add(Sphere{.center = center, .radius = radius}, options);
}

GeometryId TracerScene::add(const AnyShape& shape, const GeometryOptions& options) {
    const Affine& transform = options.world_from_geometry;
    check_transform(transform, count_);
    std::visit(
        [&]<class S>(const S& s) {
            check_shape(s, count_);
            std::uint32_t placement = kNoPlacement;
            if (transform != Affine{}) {
                placement = static_cast<std::uint32_t>(table_.placements.size());
                table_.placements.push_back({transform, inverse(transform)});
            }
            auto& column = std::get<ShapeColumn<S>>(table_.columns);
            column.shapes.push_back(s);
            column.placements.push_back(placement);
            column.materials.push_back(MaterialId{0});
            column.parts.push_back(count_);
            column.set_last_visible_to(options.visible_to);
        },
        shape);
    return GeometryId{count_++};
}

GeometryId TracerScene::add_instance(const Tracer& inner, const GeometryOptions& options) {
    const Affine& transform = options.world_from_geometry;
    check_transform(transform, count_);
    if (inner.depth_ >= kMaxInstanceDepth) {
        throw Error(
            ErrorKind::Resource,
            "instances are nested deeper than " + std::to_string(kMaxInstanceDepth) + " levels",
            place_of(count_));
    }
    depth_ = std::max(depth_, inner.depth_ + 1);
    table_.instances.push_back({.aggregate = inner.aggregate_,
                                .placement = {transform, inverse(transform)},
                                .part = count_,
                                .visible_to = options.visible_to});
    return GeometryId{count_++};
}

}  // namespace alhazen
