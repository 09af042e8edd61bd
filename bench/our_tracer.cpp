#include "our_tracer.h"

#include <algorithm>
#include <utility>

#include "alhazen/aggregates/accelerator_table.h"
#include "alhazen/primitives/primitive_table.h"

namespace alhazen::bench {

namespace {

/// A mask bit that no ray of the benchmark has.
constexpr RayMask kUnseen = 2;

template <class S>
void add_shapes(PrimitiveTable& table, const std::vector<S>& shapes, RayMask visible_to) {
    auto& column = std::get<ShapeColumn<S>>(table.columns);
    column.shapes = shapes;
    column.placements.assign(shapes.size(), kNoPlacement);
    column.materials.assign(shapes.size(), MaterialId{0});
    if (visible_to != kAllRays) column.visible_to.assign(shapes.size(), visible_to);
}

PrimitiveTable table_of(const KernelScene& scene, RayMask visible_to) {
    PrimitiveTable table;
    add_shapes(table, scene.spheres, visible_to);
    add_shapes(table, scene.cylinders, visible_to);
    PlacedMesh mesh{std::make_shared<TriangleMesh>(scene.mesh), MaterialId{0}, 0, false};
    mesh.visible_to = visible_to;
    table.meshes.push_back(std::move(mesh));
    return table;
}

PlacedMesh unseen_triangle(const Box3& box, std::uint32_t first) {
    const double edge = 1e-3 * max_component(box.size());
    TriangleMesh corner;
    corner.positions = {box.lo, box.lo + Vec3{edge, 0, 0}, box.lo + Vec3{0, edge, 0}};
    corner.triangles = {{0, 1, 2}};
    PlacedMesh mesh{std::make_shared<TriangleMesh>(std::move(corner)), MaterialId{0}, first, false};
    mesh.visible_to = kUnseen;
    return mesh;
}

std::shared_ptr<const Aggregate> build(PrimitiveTable table, const BuildOptions& options) {
    table.material_opacity = {Opacity::Opaque};
    table.finish();
    return make_aggregate("wide_bvh", std::move(table), options);
}

}  // namespace

std::shared_ptr<const Aggregate> build_ours(const KernelScene& scene, const BuildOptions& options) {
    return build(table_of(scene, kAllRays), options);
}

std::shared_ptr<const Aggregate> build_masked(const KernelScene& scene,
                                              const BuildOptions& options) {
    PrimitiveTable table = table_of(scene, kSeeing);
    const auto first = static_cast<std::uint32_t>(scene.mesh.triangles.size());
    table.meshes.push_back(unseen_triangle(scene.box(), first));
    return build(std::move(table), options);
}

OurTracer::OurTracer(const Aggregate& aggregate, const RaySet& set, RayMask mask)
    : aggregate_(aggregate),
      set_(set),
      query_(nullptr, mask),
      hits_(kBatch),
      t_(kBatch),
      u_(kBatch),
      v_(kBatch),
      ids_(kBatch),
      occluded_(std::make_unique<bool[]>(kBatch)) {}

std::size_t OurTracer::single(bool counts) {
    std::size_t count = 0;
    for (const Ray& ray : set_.rays) {
        bool found;
        if (set_.any_hit) {
            found = aggregate_.occluded(ray, query_);
        } else {
            Hit hit;
            found = aggregate_.closest(ray, hit, query_);
        }
        if (counts) count += found;
    }
    return count;
}

std::size_t OurTracer::batches(bool counts) {
    std::size_t count = 0;
    const Coherence coherence = set_.coherent ? Coherence::Coherent : Coherence::Any;
    for (std::size_t i = 0; i < set_.rays.size(); i += kBatch) {
        const std::size_t n = std::min(kBatch, set_.rays.size() - i);
        const std::span<const Ray> rays(&set_.rays[i], n);
        if (set_.any_hit) {
            aggregate_.occluded_batch(rays, {occluded_.get(), n}, query_, coherence);
            for (std::size_t k = 0; counts && k < n; ++k) count += occluded_[k];
        } else {
            aggregate_.closest_batch(rays, std::span(hits_).first(n), query_, coherence);
            for (std::size_t k = 0; counts && k < n; ++k) count += hits_[k].found();
        }
    }
    return count;
}

std::size_t OurTracer::columns(const RayColumns& rays, bool counts) {
    std::size_t count = 0;
    const Coherence coherence = set_.coherent ? Coherence::Coherent : Coherence::Any;
    for (std::size_t i = 0; i < rays.size(); i += kBatch) {
        const std::size_t n = std::min(kBatch, rays.size() - i);
        if (set_.any_hit) {
            aggregate_.occluded_columns(rays.part(i, n), {occluded_.get(), n}, query_, coherence);
            for (std::size_t k = 0; counts && k < n; ++k) count += occluded_[k];
        } else {
            const HitColumns hits = HitColumns{t_, u_, v_, ids_}.part(0, n);
            aggregate_.closest_columns(rays.part(i, n), hits, query_, coherence);
            for (std::size_t k = 0; counts && k < n; ++k) count += ids_[k] != kNoPrimitive;
        }
    }
    return count;
}

ColumnsOfRays::ColumnsOfRays(const RaySet& set) {
    for (const Ray& ray : set.rays) {
        const double row[8] = {ray.origin.x,    ray.origin.y,    ray.origin.z, ray.direction.x,
                               ray.direction.y, ray.direction.z, ray.t_min,    ray.t_max};
        for (std::size_t k = 0; k < 8; ++k) numbers_[k].push_back(static_cast<float>(row[k]));
    }
    const auto all_equal = [&](std::size_t k) {
        return std::ranges::all_of(numbers_[k], [&](float x) { return x == numbers_[k].front(); });
    };
    const bool one_point = all_equal(0) && all_equal(1) && all_equal(2);
    for (std::size_t k = 0; k < 3; ++k) {
        rays_.directions[k] = numbers_[3 + k];
        if (one_point) {
            rays_.origin[k] = numbers_[k].front();
        } else {
            rays_.origins[k] = numbers_[k];
        }
    }
    if (all_equal(6)) {
        rays_.range[0] = numbers_[6].front();
    } else {
        rays_.t_min = numbers_[6];
    }
    if (all_equal(7)) {
        rays_.range[1] = numbers_[7].front();
    } else {
        rays_.t_max = numbers_[7];
    }
}

WorkPerRay count_work(const Aggregate& aggregate, const RaySet& set) {
    TraversalStats stats;
    for (const Ray& ray : set.rays) {
        Hit hit;
        if (set.any_hit) {
            (void)aggregate.occluded(ray, &stats);
        } else {
            (void)aggregate.closest(ray, hit, &stats);
        }
    }
    const auto per_ray = [&](std::uint64_t n) {
        return static_cast<double>(n) / static_cast<double>(set.rays.size());
    };
    return {per_ray(stats.node_visits), per_ray(stats.primitive_tests),
            per_ray(stats.primitive_hits)};
}

}  // namespace alhazen::bench
