#include "our_tracer.h"

#include <algorithm>
#include <utility>

#include "alhazen/scene/accelerator_table.h"
#include "alhazen/scene/primitive_table.h"

namespace alhazen::bench {

namespace {

template <class S>
void add_shapes(PrimitiveTable& table, const std::vector<S>& shapes) {
    auto& column = std::get<ShapeColumn<S>>(table.columns);
    column.shapes = shapes;
    column.placements.assign(shapes.size(), kNoPlacement);
    column.materials.assign(shapes.size(), MaterialId{0});
}

}  // namespace

std::shared_ptr<const Aggregate> build_ours(const KernelScene& scene, const BuildOptions& options) {
    PrimitiveTable table;
    add_shapes(table, scene.spheres);
    add_shapes(table, scene.cylinders);
    table.meshes.push_back({std::make_shared<TriangleMesh>(scene.mesh), MaterialId{0}, 0, false});
    table.material_opacity = {Opacity::Opaque};
    table.finish();
    return make_aggregate("wide_bvh", std::move(table), options);
}

std::size_t trace_single(const Aggregate& aggregate, const RaySet& set) {
    std::size_t hits = 0;
    for (const Ray& ray : set.rays) {
        if (set.any_hit) {
            hits += aggregate.occluded(ray, nullptr);
        } else {
            Hit hit;
            hits += aggregate.closest(ray, hit, nullptr);
        }
    }
    return hits;
}

std::size_t trace_batches(const Aggregate& aggregate, const RaySet& set) {
    std::vector<Hit> hits(kBatch);
    const auto occluded = std::make_unique<bool[]>(kBatch);
    std::size_t count = 0;
    const Coherence coherence = set.coherent ? Coherence::Coherent : Coherence::Any;
    for (std::size_t i = 0; i < set.rays.size(); i += kBatch) {
        const std::size_t n = std::min(kBatch, set.rays.size() - i);
        const std::span<const Ray> rays(&set.rays[i], n);
        if (set.any_hit) {
            aggregate.occluded_batch(rays, {occluded.get(), n}, nullptr, coherence);
            for (std::size_t k = 0; k < n; ++k) count += occluded[k];
        } else {
            aggregate.closest_batch(rays, std::span(hits).first(n), nullptr, coherence);
            for (std::size_t k = 0; k < n; ++k) count += hits[k].found();
        }
    }
    return count;
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
