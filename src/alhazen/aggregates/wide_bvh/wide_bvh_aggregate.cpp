#include "alhazen/aggregates/wide_bvh/wide_bvh_aggregate.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "alhazen/aggregates/wide_bvh/leaves/recent_occluders.h"
#include "alhazen/aggregates/wide_bvh/wide_bvh_file.h"
#include "alhazen/base/error.h"
#include "alhazen/base/huge_pages.h"
#include "alhazen/primitives/bounded_primitives.h"
#include "alhazen/primitives/surface.h"

namespace alhazen {

namespace {

/// Number of hits that are cleared together before their rays are traced, so that they stay in the
/// cache.
constexpr std::size_t kInCache = 512;

/// What the test of a triangle in float adds to the error bound of its points. `scale`: of the
/// frame.
double float_error(const Vec3& a, const Vec3& b, const Vec3& c, double scale) {
    const Vec3 ab = b - a, ac = c - a, bc = c - b;
    const double longest =
        std::sqrt(std::max({length_squared(ab), length_squared(ac), length_squared(bc)}));
    // Its height over the longest side is area / longest.
    const double area = length(cross(ab, ac));
    constexpr double e = 0x1p-24;
    const double slender = 0.125 * e * longest * longest * (longest / area);
    // Written so that NaN, of a triangle without area, takes the length.
    const double most = 0.125 * longest;
    return 0.25 * e / scale + (slender < most ? slender : most);
}

}  // namespace

WideBvhAggregate::WideBvhAggregate(PrimitiveTable table, const BuildOptions& options)
    : table_(std::move(table)),
      precision_(options.precision),
      kernels_(wide_bvh_kernels(options.width, options.precision)) {
    const BoundedPrimitives bounded(table_);
    box_ = bounded.all();
    unbounded_ = bounded.unbounded();
    treeless_ = TreelessPackets(table_, unbounded_);
    layout_ = build_wide_bvh(table_, bounded, options);
    built_cost_ = layout_.sah_cost();
    finish_build();
}

WideBvhAggregate::WideBvhAggregate(PrimitiveTable table, const std::filesystem::path& file)
    : table_(std::move(table)) {
    StoredWideBvh stored = load_wide_bvh(file, table_);
    box_ = stored.box;
    unbounded_ = std::move(stored.unbounded);
    treeless_ = TreelessPackets(table_, unbounded_);
    layout_ = std::move(stored.layout);
    precision_ = stored.precision;
    kernels_ = wide_bvh_kernels(layout_.tree.width, precision_);
    built_cost_ = layout_.sah_cost();
    finish_build();
}

std::shared_ptr<const WideBvhAggregate> WideBvhAggregate::load(PrimitiveTable table,
                                                               const std::filesystem::path& file) {
    return std::shared_ptr<const WideBvhAggregate>(new WideBvhAggregate(std::move(table), file));
}

void WideBvhAggregate::save(const std::filesystem::path& file) const {
    save_wide_bvh(file, layout_, box_, unbounded_, table_, precision_);
}

RefitReport WideBvhAggregate::refit(PrimitiveTable moved) {
    const BoundedPrimitives bounded(moved);
    if (moved.size() != table_.size() || bounded.unbounded() != unbounded_) {
        throw Error(ErrorKind::Usage, "the tree was built over other primitives");
    }
    alhazen::refit(layout_, moved, bounded);
    box_ = bounded.all();
    table_ = std::move(moved);
    finish_build();
    RefitReport report;
    report.cost = layout_.sah_cost();
    if (built_cost_ > 0) report.growth = report.cost / built_cost_;
    return report;
}

void WideBvhAggregate::finish_build() {
    outside_ = UnboundedParts(table_, unbounded_);
    all_ = scene(kAllRays);
    only_tree_ = outside_.empty() && !layout_.tree.empty;
    schedules_ = Schedules(table_, layout_, unbounded_, !treeless_.empty(),
                           kernels_.plain.closest_coherent != nullptr);
    all_.find_largest_leaf();
    // Incoherent rays read the meshes at random.
    for (const PlacedMesh& placed : table_.meshes) {
        collapse_to_huge_pages(std::span(placed.mesh->triangles));
        collapse_to_huge_pages(std::span(placed.mesh->positions));
    }
}

std::size_t WideBvhAggregate::memory_bytes() const {
    return layout_.memory_bytes() + unbounded_.capacity() * sizeof(PrimitiveId);
}

void WideBvhAggregate::finish_hits(std::vector<Hit>& hits, std::size_t before) const {
    if (hits.size() - before < 2) return;
    sort_appended(hits, before);
    // A triangle may lie in several leaves (accel/wide_bvh/build/spatial_split.h), but is one hit.
    const auto is_triangle = [&](const Hit& hit) {
        const auto id = static_cast<std::uint32_t>(hit.primitive);
        return hit.path.empty() && table_.first(kTriangleKind) <= id &&
               id < table_.first(kTriangleKind + 1);
    };
    const auto last =
        std::unique(hits.begin() + static_cast<std::ptrdiff_t>(before), hits.end(),
                    [&](const Hit& a, const Hit& b) {
                        return a.primitive == b.primitive && is_triangle(a) && is_triangle(b);
                    });
    hits.erase(last, hits.end());
}

void WideBvhAggregate::complete(const Ray&, double, PrimitiveId primitive, Surface& surface) const {
    if (precision_ != Precision::Fast || table_.kind(primitive) != kTriangleKind) return;
    const std::uint32_t index = table_.index(primitive);
    const PlacedMesh& placed = table_.mesh_of(index);
    const TriangleMesh& mesh = *placed.mesh;
    const auto& corners = mesh.triangles[index - placed.first_triangle];
    const double error = float_error(mesh.positions[corners[0]], mesh.positions[corners[1]],
                                     mesh.positions[corners[2]], layout_.frame.scale);
    surface.error += Vec3{error, error, error};
}

bool WideBvhAggregate::closest(const Ray& ray, Hit& hit, RayQuery query) const {
    if (asks_tree_alone(query)) [[likely]] {
        return kernels_.plain.closest_of_one(all_, ray, hit, nullptr);
    }
    return closest_of_any(ray, hit, query);
}

bool WideBvhAggregate::closest_of_any(const Ray& ray, Hit& hit, RayQuery query) const {
    hit = Hit{};
    outside_.closest(table_, ray, hit, query);
    if (!layout_.tree.empty)
        kernels_.for_stats(query.stats).closest(scene(query.mask), ray, hit, query.stats);
    return hit.found();
}

bool WideBvhAggregate::occluded(const Ray& ray, RayQuery query) const {
    if (asks_tree_alone(query)) [[likely]] {
        return kernels_.plain.occluded(all_, ray, nullptr);
    }
    return occluded_by_any(ray, query);
}

bool WideBvhAggregate::occluded_by_any(const Ray& ray, RayQuery query) const {
    if (outside_.occluded(table_, ray, query)) return true;
    return !layout_.tree.empty &&
           kernels_.for_stats(query.stats).occluded(scene(query.mask), ray, query.stats);
}

void WideBvhAggregate::all_hits(const Ray& ray, std::vector<Hit>& hits, RayQuery query) const {
    const std::size_t before = hits.size();
    outside_.all_hits(table_, ray, hits, query);
    if (!layout_.tree.empty)
        (void)kernels_.for_stats(query.stats).all_hits(scene(query.mask), ray, hits, query.stats);
    finish_hits(hits, before);
}

bool WideBvhAggregate::shadowed(const Ray& ray, std::vector<Hit>& crossings, RayQuery query) const {
    const std::size_t before = crossings.size();
    if (outside_.shadowed(table_, ray, crossings, query)) return true;
    if (!layout_.tree.empty &&
        kernels_.for_stats(query.stats).shadowed(scene(query.mask), ray, crossings, query.stats))
        return true;
    finish_hits(crossings, before);
    return false;
}

void WideBvhAggregate::closest_batch(std::span<const Ray> rays, std::span<Hit> hits, RayQuery query,
                                     Coherence coherence) const {
    // A packet fetches the rays of the next one, those of the next part it does not.
    if (takes_whole(coherence)) return trace_closest(rays, hits, true, query, coherence);
    for (std::size_t i = 0; i < rays.size(); i += kInCache) {
        const std::size_t count = std::min(kInCache, rays.size() - i);
        const std::span<Hit> here = hits.subspan(i, count);
        for (Hit& hit : here) hit = Hit{};
        trace_closest(rays.subspan(i, count), here, false, query, coherence);
    }
}

void WideBvhAggregate::trace_closest(std::span<const Ray> rays, std::span<Hit> hits, bool unset,
                                     RayQuery query, Coherence coherence) const {
    for (std::size_t i = 0; i < rays.size() && !outside_.empty(); ++i) {
        outside_.closest(table_, rays[i], hits[i], query);
    }
    if (layout_.tree.empty) return;
    const WideBvhScene seen = packet_scene(query, closest_failures_);
    const WideBvhKernels& kernels = kernels_.for_stats(query.stats);
    switch (schedules_.of_batch(coherence, rays.size())) {
        case Schedule::Single: {
            // Without earlier hits that limit a ray.
            if (outside_.empty()) {
                for (std::size_t i = 0; i < rays.size(); ++i) {
                    (void)kernels.closest_of_one(seen, rays[i], hits[i], query.stats);
                }
                return;
            }
            for (std::size_t i = 0; i < rays.size(); ++i) {
                kernels.closest(seen, rays[i], hits[i], query.stats);
            }
            return;
        }
        case Schedule::Stream:
            return kernels.closest_batch(seen, rays, hits, query.stats);
        case Schedule::Packets:
            return kernels.closest_coherent(seen, rays, hits, unset, query.stats);
        case Schedule::TreelessPackets:
            return treeless_.closest(table_, rays, hits, query);
    }
}

void WideBvhAggregate::occluded_batch(std::span<const Ray> rays, std::span<bool> occluded,
                                      RayQuery query, Coherence coherence) const {
    std::fill(occluded.begin(), occluded.end(), false);
    for (std::size_t i = 0; i < rays.size() && !outside_.empty(); ++i) {
        occluded[i] = outside_.occluded(table_, rays[i], query);
    }
    if (layout_.tree.empty) return;
    WideBvhScene seen = packet_scene(query, occluded_failures_);
    const WideBvhKernels& kernels = kernels_.for_stats(query.stats);
    switch (schedules_.of_batch(coherence, rays.size())) {
        case Schedule::Single: {
            if (!layout_.others.empty()) {
                RecentOccluders recent;
                seen.recent = &recent;
                return kernels.occluded_batch(seen, rays, occluded, query.stats);
            }
            for (std::size_t i = 0; i < rays.size(); ++i) {
                if (!occluded[i]) occluded[i] = kernels.occluded(seen, rays[i], query.stats);
            }
            return;
        }
        case Schedule::Stream:
            return kernels.occluded_batch(seen, rays, occluded, query.stats);
        case Schedule::Packets:
            return kernels.occluded_coherent(seen, rays, occluded, query.stats);
        case Schedule::TreelessPackets:
            return treeless_.occluded(table_, rays, occluded, query);
    }
}

void WideBvhAggregate::closest_columns(const RayColumns& rays, const HitColumns& hits,
                                       RayQuery query, Coherence coherence) const {
    if (takes_whole(coherence) &&
        kernels_.for_stats(query.stats)
            .closest_columns(batch_scene(query.mask), rays, hits, query.stats)) {
        return;
    }
    if (streams_alone(coherence, rays.size())) {
        std::vector<Hit> found(std::min(kInCache, rays.size()));
        for (std::size_t i = 0; i < rays.size(); i += kInCache) {
            const std::span<Hit> here = std::span(found).first(std::min(kInCache, rays.size() - i));
            if (i > 0) std::fill(here.begin(), here.end(), Hit{});
            kernels_.for_stats(query.stats)
                .closest_column_stream(batch_scene(query.mask), rays.part(i, here.size()), here,
                                       query.stats);
            hits.set(i, here);
        }
        return;
    }
    Aggregate::closest_columns(rays, hits, query, coherence);
}

void WideBvhAggregate::occluded_columns(const RayColumns& rays, std::span<bool> occluded,
                                        RayQuery query, Coherence coherence) const {
    if (takes_whole(coherence) && kernels_.for_stats(query.stats)
                                      .occluded_columns(packet_scene(query, occluded_failures_),
                                                        rays, occluded, query.stats)) {
        return;
    }
    if (streams_alone(coherence, rays.size())) {
        std::fill(occluded.begin(), occluded.end(), false);
        return kernels_.for_stats(query.stats)
            .occluded_column_stream(batch_scene(query.mask), rays, occluded, query.stats);
    }
    Aggregate::occluded_columns(rays, occluded, query, coherence);
}

void append_hit(std::vector<Hit>& hits, const ShapeHit& hit, PrimitiveId id) {
    Hit& appended = hits.emplace_back();
    static_cast<ShapeHit&>(appended) = hit;
    appended.primitive = id;
}

}  // namespace alhazen
