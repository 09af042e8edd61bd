#include "alhazen/tracer/tracer.h"

#include <utility>

#include "alhazen/base/error.h"
#include "alhazen/scene/wide_bvh_aggregate.h"

namespace alhazen {
namespace {

void check_lengths(std::size_t rays, std::size_t results) {
    if (rays == results) return;
    throw Error(ErrorKind::Usage, "a batch of " + std::to_string(rays) + " rays with room for " +
                                      std::to_string(results) + " results, expected as many");
}

/// The table as the builders want it. Nothing is transparent: there are no materials.
PrimitiveTable finished(PrimitiveTable table) {
    table.material_opacity = {Opacity::Opaque};
    table.finish();
    return table;
}

/// Throws unless the id is one of the table's, an instance or not as expected.
void check_id(const PrimitiveTable& table, PrimitiveId id, bool instance) {
    const auto i = static_cast<std::uint32_t>(id);
    if (i < table.size() && (i >= table.first(kInstanceKind)) == instance) return;
    throw Error(ErrorKind::Usage, id == kNoPrimitive ? "there are no details of a ray without a hit"
                                                     : "the hit is not one of this tracer");
}

}  // namespace

Tracer::Tracer(TracerScene scene, const TracerOptions& options)
    : Tracer(make_aggregate(options.accelerator, finished(std::move(scene.table_)), options.build),
             scene.count_, scene.depth_) {}

Tracer Tracer::load(TracerScene scene, const std::filesystem::path& file) {
    return {WideBvhAggregate::load(finished(std::move(scene.table_)), file), scene.count_,
            scene.depth_};
}

void Tracer::save(const std::filesystem::path& file) const {
    const auto* wide = dynamic_cast<const WideBvhAggregate*>(aggregate_.get());
    if (wide == nullptr) {
        throw Error(ErrorKind::Usage, std::string("only the accelerator ") +
                                          WideBvhAggregate::kName + " can be stored");
    }
    wide->save(file);
}

bool Tracer::intersect(const Ray& ray, Hit& hit, RayMask mask) const {
    return aggregate_->closest(ray, hit, {nullptr, mask});
}

bool Tracer::occluded(const Ray& ray, RayMask mask) const {
    return aggregate_->occluded(ray, {nullptr, mask});
}

void Tracer::all_hits(const Ray& ray, std::vector<Hit>& hits, RayMask mask) const {
    hits.clear();
    aggregate_->all_hits(ray, hits, {nullptr, mask});
}

void Tracer::intersect(std::span<const Ray> rays, std::span<Hit> hits, RayMask mask) const {
    check_lengths(rays.size(), hits.size());
    aggregate_->closest_batch(rays, hits, {nullptr, mask});
}

void Tracer::occluded(std::span<const Ray> rays, std::span<bool> occluded, RayMask mask) const {
    check_lengths(rays.size(), occluded.size());
    aggregate_->occluded_batch(rays, occluded, {nullptr, mask});
}

void Tracer::all_hits(std::span<const Ray> rays, HitLists& lists, RayMask mask) const {
    lists.hits.clear();
    lists.ends.clear();
    lists.ends.reserve(rays.size());
    for (const Ray& ray : rays) {
        aggregate_->all_hits(ray, lists.hits, {nullptr, mask});
        lists.ends.push_back(lists.hits.size());
    }
}

HitDetails Tracer::details(const Ray& ray, const Hit& hit) const {
    HitDetails details;
    const PrimitiveTable* table = &aggregate_->primitives();
    for (std::size_t level = hit.path.size(); level-- > 0;) {
        check_id(*table, hit.path[level], true);
        const Instance& instance = table->instances[table->index(hit.path[level])];
        details.instances.push_back(GeometryId{instance.part});
        table = &instance.aggregate->primitives();
    }
    check_id(*table, hit.primitive, false);
    static_cast<Surface&>(details) = surface_at(*aggregate_, ray, hit);
    details.geometry = GeometryId{details.part};
    if (table->kind(hit.primitive) == kTriangleKind) {
        const std::uint32_t triangle = table->index(hit.primitive);
        details.primitive = triangle - table->mesh_of(triangle).first_triangle;
    }
    return details;
}

}  // namespace alhazen
