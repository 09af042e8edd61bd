#include "placed_triangles.h"

#include <fmt/format.h>

#include <algorithm>
#include <unordered_map>

#include "alhazen/base/error.h"
#include "alhazen/base/interruption.h"
#include "alhazen/csg/solid_aggregate.h"
#include "alhazen/primitives/primitive_table.h"
#include "alhazen/session/aov_pictures.h"
#include "alhazen/shapes/meshes/triangle_normal.h"

namespace alhazen::python {

namespace {

/// Of an aggregate with what its instances hold.
struct Census {
    double triangles = 0, others = 0;  ///< of instances nested in each other there may be many
    std::string first_other;           ///< name and kind
    bool has_instances = false;
};

class CensusTaker {
  public:
    explicit CensusTaker(const SceneDescription& description) : description_(description) {}

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
            census.others = 1;
            census.first_other = fmt::format("'{}', a solid of others", name(part));
            return census;
        }
        const PrimitiveTable& table = aggregate.primitives();
        census.triangles = table.first(kInstanceKind) - table.first(kTriangleKind);
        census.others = table.first(kTriangleKind);
        std::apply([&](const auto&... column) { (name_first(column, census), ...); },
                   table.columns);
        for (const Instance& instance : table.instances) {
            const Census& inner = of(*instance.aggregate, instance.part);
            census.triangles += inner.triangles;
            census.others += inner.others;
            census.has_instances = true;
            if (census.first_other.empty()) census.first_other = inner.first_other;
        }
        return census;
    }
    template <class Column>
    void name_first(const Column& column, Census& census) const {
        if (column.shapes.empty() || !census.first_other.empty()) return;
        const std::uint32_t part = column.parts.empty() ? 0 : column.parts.front();
        census.first_other = fmt::format("'{}', a {}", name(part), column.shapes.front().kName);
    }
    [[nodiscard]] std::string name(std::uint32_t part) const {
        return part_name(description_, part);
    }

    const SceneDescription& description_;
    std::unordered_map<const Aggregate*, Census> known_;
};

void check(const Census& census) {
    if (census.others > 0) {
        throw Error(
            ErrorKind::Usage,
            fmt::format("the nearest points are those of triangle meshes, which {} is not: "
                        "{:.0f} of the {:.0f} primitives are shapes or solids",
                        census.first_other, census.others, census.others + census.triangles));
    }
    if (census.has_instances && census.triangles > PlacedTriangles::kMost) {
        throw Error(ErrorKind::Resource,
                    fmt::format("the scene has {:.0f} triangles, counted at each place of an "
                                "instance; the nearest points are found of at most {}",
                                census.triangles, PlacedTriangles::kMost));
    }
}

}  // namespace

/// Visits all meshes at all places.
class PlacedTriangles::Collector {
  public:
    Collector(const Tracer& tracer, std::vector<Run>& runs) : tracer_(tracer), runs_(runs) {}

    void visit(const Aggregate& aggregate, const Placement& world, bool placed) {
        const PrimitiveTable& table = aggregate.primitives();
        for (const PlacedMesh& mesh : table.meshes) add(table, mesh, world, placed);
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
    [[nodiscard]] std::vector<NearestTriangles::Corners>& triangles() { return triangles_; }

  private:
    void add(const PrimitiveTable& table, const PlacedMesh& mesh, const Placement& world,
             bool placed) {
        if (mesh.mesh->triangles.empty()) return;
        Hit hit;
        hit.primitive = PrimitiveId{table.first(kTriangleKind) + mesh.first_triangle};
        for (std::size_t i = path_.size(); i-- > 0;) hit.path.push_back(path_[i]);
        runs_.push_back({static_cast<std::uint32_t>(triangles_.size()),
                         static_cast<std::uint32_t>(tracer_.ids(hit).geometry), &mesh, placed,
                         world});
        const auto count = static_cast<std::uint32_t>(mesh.mesh->triangles.size());
        for (std::uint32_t i = 0; i < count; ++i) {
            if (i % 65536 == 0) interruption_point();
            NearestTriangles::Corners corners = table.triangle_vertices(mesh.first_triangle + i);
            if (placed) {
                for (Vec3& corner : corners) corner = world.outer_from_inner.point(corner);
            }
            triangles_.push_back(corners);
        }
    }

    const Tracer& tracer_;
    std::vector<Run>& runs_;
    std::vector<PrimitiveId> path_;  ///< outermost first
    std::vector<NearestTriangles::Corners> triangles_;
};

PlacedTriangles::PlacedTriangles(const Tracer& tracer, const SceneDescription& description)
    : tree_([&] {
          check(CensusTaker(description).of(tracer.aggregate(), 0));
          Collector collector(tracer, runs_);
          collector.visit(tracer.aggregate(), {}, false);
          return NearestTriangles(collector.triangles());
      }()) {}

PlacedTriangles::Found PlacedTriangles::nearest(const Vec3& point) const {
    Found found;
    static_cast<NearestTriangle&>(found) = tree_.nearest(point);
    if (!found.found()) return found;
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
    return found;
}

}  // namespace alhazen::python
