#include "placed_surfaces.h"

#include <fmt/format.h>

#include <algorithm>
#include <unordered_map>

#include "alhazen/base/error.h"
#include "alhazen/base/interruption.h"
#include "alhazen/csg/solid_aggregate.h"
#include "alhazen/primitives/primitive_columns.h"
#include "alhazen/session/aov_pictures.h"
#include "alhazen/shapes/meshes/triangle_normal.h"

namespace alhazen::python {

namespace {

/// Sums over an aggregate, instances expanded.
struct Census {
    double bytes = 0;         ///< double, as nested instances may expand to very many
    std::string first_solid;  ///< name of the first solid
    bool has_instances = false;
};

class CensusTaker {
  public:
    /// Without instances nothing is counted, as everything is stored once.
    CensusTaker(const SceneDescription& description, const Aggregate& scene)
        : description_(description), weighs_(!scene.primitives().instances.empty()) {}

    const Census& of(const Aggregate& aggregate, std::uint32_t part) {
        const auto [known, fresh] = known_.try_emplace(&aggregate);
        if (fresh) {
            Census census = taken(aggregate, part);
            return known_[&aggregate] = std::move(census);
        }
        return known->second;
    }

  private:
    Census taken(const Aggregate& aggregate, std::uint32_t part) {
        Census census;
        if (dynamic_cast<const SolidAggregate*>(&aggregate) != nullptr) {
            census.first_solid = part_name(description_, part);
            return census;
        }
        const PrimitiveTable& table = aggregate.primitives();
        for (const PlacedMesh& mesh : table.meshes) {
            census.bytes +=
                PlacedSurfaces::kTriangleBytes * static_cast<double>(mesh.mesh->triangles.size());
        }
        if (weighs_) {
            std::apply([&](const auto&... column) { ((census.bytes += bytes_of(column)), ...); },
                       table.columns);
        }
        for (const Instance& instance : table.instances) {
            const Census& inner = of(*instance.aggregate, instance.part);
            census.bytes += inner.bytes;
            census.has_instances = true;
            if (census.first_solid.empty()) census.first_solid = inner.first_solid;
        }
        return census;
    }

    /// Bytes of shapes that an instance may stretch.
    template <class S>
    static double bytes_of(const ShapeColumn<S>& column) {
        const Affine stretch = Affine::scale({1, 2, 3});
        const Placement stretched{stretch, inverse(stretch)};
        double sum = 0;
        for (const S& shape : column.shapes) {
            interruption_point();
            const AnyShape any(shape);
            // Shapes without nearest points cause an error later.
            if (!nearest_refusal(any, {}).empty()) continue;
            sum += static_cast<double>(ExactSurface(any, stretched).bytes() + kTreeBytes);
        }
        return sum;
    }

    /// Bytes of a shape: its id, its box and its part of the tree.
    static constexpr std::size_t kTreeBytes = 128;
    const SceneDescription& description_;
    const bool weighs_;
    std::unordered_map<const Aggregate*, Census> known_;
};

void check(const Census& census) {
    if (!census.first_solid.empty()) {
        throw Error(ErrorKind::Usage,
                    fmt::format("nearest points are those of meshes and shapes; '{}' is a solid "
                                "made of others",
                                census.first_solid));
    }
    if (census.has_instances && census.bytes > PlacedSurfaces::kMostBytes) {
        throw Error(ErrorKind::Resource,
                    fmt::format("the scene's triangles and shapes, counted at each place of an "
                                "instance, take up to {:.2g} GB; the nearest points are found of "
                                "at most {:.2g} GB",
                                1e-9 * census.bytes, 1e-9 * PlacedSurfaces::kMostBytes));
    }
}

/// The box of a transformed box.
Box3 box_of(const Box3& box, const Affine& outer_from_inner) {
    if (outer_from_inner == Affine{} || !box.bounded()) return box;
    Box3 result;
    for (int i = 0; i < 8; ++i) {
        result.include(
            outer_from_inner.point({(i & 1 ? box.hi : box.lo).x, (i & 2 ? box.hi : box.lo).y,
                                    (i & 4 ? box.hi : box.lo).z}));
    }
    const double pad =
        1e-14 * std::max(max_component(abs(result.lo)), max_component(abs(result.hi)));
    return {result.lo - Vec3{pad, pad, pad}, result.hi + Vec3{pad, pad, pad}};
}

}  // namespace

/// Visits all meshes and shapes in all places.
class PlacedSurfaces::Collector {
  public:
    Collector(const Tracer& tracer, const SceneDescription& description)
        : tracer_(tracer), description_(description) {
        check(CensusTaker(description, tracer.aggregate()).of(tracer.aggregate(), 0));
        visit(tracer.aggregate(), {}, false);
    }
    std::vector<Run> runs;
    std::vector<PlacedShape> shapes;
    std::vector<Box3> shape_boxes;
    std::vector<NearestTriangles::Corners> triangles;

  private:
    void visit(const Aggregate& aggregate, const Placement& world, bool placed) {
        const PrimitiveTable& table = aggregate.primitives();
        for (const PlacedMesh& mesh : table.meshes) add(table, mesh, world, placed);
        std::uint32_t kind = 0;
        std::apply([&](const auto&... column) { (add(table, kind++, column, world), ...); },
                   table.columns);
        for (std::size_t i = 0; i < table.instances.size(); ++i) {
            interruption_point();
            const Instance& instance = table.instances[i];
            path_.push_back(
                PrimitiveId{table.first(kInstanceKind) + static_cast<std::uint32_t>(i)});
            visit(*instance.aggregate,
                  {world.outer_from_inner * instance.placement.outer_from_inner,
                   instance.placement.inner_from_outer * world.inner_from_outer},
                  placed || !instance.in_place);
            path_.pop_back();
        }
    }
    /// The geometry id of a primitive of the current table.
    [[nodiscard]] std::uint32_t geometry_of(std::uint32_t primitive) const {
        Hit hit;
        hit.primitive = PrimitiveId{primitive};
        for (std::size_t i = path_.size(); i-- > 0;) hit.path.push_back(path_[i]);
        return static_cast<std::uint32_t>(tracer_.ids(hit).geometry);
    }
    template <class S>
    void add(const PrimitiveTable& table, std::uint32_t kind, const ShapeColumn<S>& column,
             const Placement& world) {
        const std::uint32_t first = table.first(kind);
        for (std::uint32_t i = 0; i < column.shapes.size(); ++i) {
            if (i % 1024 == 0) interruption_point();
            Placement place = world;
            if (column.placements[i] != kNoPlacement) {
                const Placement& own = table.placements[column.placements[i]];
                place = {world.outer_from_inner * own.outer_from_inner,
                         own.inner_from_outer * world.inner_from_outer};
            }
            const AnyShape shape(column.shapes[i]);
            const std::uint32_t geometry = geometry_of(first + i);
            if (const std::string why = nearest_refusal(shape, place.outer_from_inner);
                !why.empty()) {
                throw Error(ErrorKind::Usage,
                            fmt::format("'{}', a {}, {}: its nearest points are not known",
                                        part_name(description_, geometry), S::kName, why));
            }
            shapes.push_back({ExactSurface(shape, place), geometry});
            shape_boxes.push_back(box_of(table.box(first + i), world.outer_from_inner));
        }
    }
    void add(const PrimitiveTable& table, const PlacedMesh& mesh, const Placement& world,
             bool placed) {
        if (mesh.mesh->triangles.empty()) return;
        runs.push_back({static_cast<std::uint32_t>(triangles.size()),
                        geometry_of(table.first(kTriangleKind) + mesh.first_triangle), &mesh,
                        placed, world});
        const auto count = static_cast<std::uint32_t>(mesh.mesh->triangles.size());
        for (std::uint32_t i = 0; i < count; ++i) {
            if (i % 65536 == 0) interruption_point();
            NearestTriangles::Corners corners = table.triangle_vertices(mesh.first_triangle + i);
            if (placed) {
                for (Vec3& corner : corners) corner = world.outer_from_inner.point(corner);
            }
            triangles.push_back(corners);
        }
    }

    const Tracer& tracer_;
    const SceneDescription& description_;
    std::vector<PrimitiveId> path_;  ///< outermost first
};

PlacedSurfaces::PlacedSurfaces(const Tracer& tracer, const SceneDescription& description)
    : PlacedSurfaces(Collector(tracer, description)) {}

PlacedSurfaces::PlacedSurfaces(Collector collector)
    : runs_(std::move(collector.runs)),
      shapes_(std::move(collector.shapes)),
      tree_(collector.triangles),
      shape_tree_(collector.shape_boxes) {}

void PlacedSurfaces::take_nearer_shape(const Vec3& point, Found& found) const {
    if (shapes_.empty() || !is_finite(point)) return;
    double limit = found.squared;
    const std::uint32_t nearest = shape_tree_.nearest(
        point, limit, [&](std::uint32_t i) { return shapes_[i].surface.nearest(point).squared; });
    if (nearest == NearestBoxes::kNone) return;
    const PointOnSurface best = shapes_[nearest].surface.nearest(point);
    found = {};
    found.point = best.point;
    found.normal = best.normal;
    found.squared = best.squared;
    found.geometry = shapes_[nearest].geometry;
    found.primitive = 0;
}

PlacedSurfaces::Found PlacedSurfaces::nearest(const Vec3& point) const {
    Found found;
    static_cast<NearestTriangle&>(found) = tree_.nearest(point);
    if (found.found()) name(found);
    take_nearer_shape(point, found);
    return found;
}

void PlacedSurfaces::name(Found& found) const {
    const auto after = std::upper_bound(
        runs_.begin(), runs_.end(), found.triangle,
        [](std::uint32_t triangle, const Run& run) { return triangle < run.first; });
    const Run& run = *(after - 1);
    found.geometry = run.geometry;
    found.primitive = found.triangle - run.first;
    found.normal = triangle_normal(*run.mesh->mesh, found.primitive);
    if (run.mesh->mirrored) found.normal = -found.normal;
    if (run.placed) {
        found.normal = normalize(transpose_times(run.world.inner_from_outer.linear, found.normal));
    }
}

}  // namespace alhazen::python
