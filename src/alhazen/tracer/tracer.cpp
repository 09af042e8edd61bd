#include "alhazen/tracer/tracer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>

#include "alhazen/aggregates/wide_bvh/wide_bvh_aggregate.h"
#include "alhazen/base/error.h"
#include "alhazen/geometry/ray_scale.h"
#include "alhazen/math/constants.h"
#include "alhazen/primitives/primitive_columns.h"
#include "alhazen/scene/scene.h"
#include "alhazen/shapes/meshes/triangle_normal.h"

namespace alhazen {
namespace {

void check_lengths(std::size_t rays, std::size_t results) {
    if (rays == results) return;
    throw Error(ErrorKind::Usage, "a batch of " + std::to_string(rays) + " rays has " +
                                      std::to_string(results) + " results; expected one per ray");
}

/// Completes the table for the builders. All geometry is opaque: there are no materials.
PrimitiveTable finished(PrimitiveTable table) {
    table.material_opacity = {Opacity::Opaque};
    table.finish();
    return table;
}

/// Throws unless the id is in the table and is (or is not) an instance, as expected.
void check_id(const PrimitiveTable& table, PrimitiveId id, bool instance) {
    const auto i = static_cast<std::uint32_t>(id);
    if (i < table.size() && (i >= table.first(kInstanceKind)) == instance) return;
    throw Error(ErrorKind::Usage, id == kNoPrimitive ? "the ray has no hit"
                                                     : "the hit does not belong to this tracer");
}

/// A hit in the units of the rescaled ray.
struct UsualHit {
    Hit hit;
    /// Other crossings of the primitive that `hit` may stand for, as its t left the range of double
    /// in the units of the given ray; u, v and part are the same.
    std::vector<Hit> others;
    bool lost = false;  ///< not found again
};

/// Converts the t of `hit` to the units of `usual`. Where the digits of t are lost, finds the hit
/// again, of several crossings with its t the nearest.
UsualHit usual_hit(const Aggregate& aggregate, const Ray& usual, const Hit& hit, int exponent) {
    UsualHit found{hit, {}, false};
    found.hit.t = std::ldexp(hit.t, exponent);
    if (exponent == 0 || keeps_digits(hit.t)) return found;
    std::vector<Hit> all;
    aggregate.all_hits(usual, all, nullptr);
    std::erase_if(all, [&](const Hit& other) {
        return other.primitive != hit.primitive || other.path != hit.path ||
               other.part != hit.part || std::ldexp(other.t, -exponent) != hit.t;
    });
    // Parameters may be those of a test in float (Precision::Fast).
    const auto same = [&](const Hit& other) { return other.u == hit.u && other.v == hit.v; };
    if (std::any_of(all.begin(), all.end(), same)) std::erase_if(all, std::not_fn(same));
    found.lost = all.empty();
    if (found.lost) return found;
    found.hit.t = all.front().t;
    found.others.assign(all.begin() + 1, all.end());
    return found;
}

/// Widens the bound of the error of the surface at `hit` where it may be another.
void cover_others(const Aggregate& aggregate, const Ray& usual, const UsualHit& hit,
                  Surface& surface) {
    if (hit.lost) surface.error = {kInfinity, kInfinity, kInfinity};
    Vec3 farthest;
    Surface other;
    for (const Hit& one : hit.others) {
        set_surface(aggregate, usual, one, CoordinateNeed::none(), other);
        const Vec3 away = abs(other.point - surface.point);
        for (int k = 0; k < 3; ++k) farthest[k] = std::max(farthest[k], away[k]);
    }
    surface.error += farthest;
}

/// Calls trace(ray, exponent) with a ray of usual length, whose t are 2^exponent times larger.
template <class Trace>
decltype(auto) with_usual(const Ray& ray, const Trace& trace) {
    const int exponent = unusual_exponent(ray.direction);
    return exponent == 0 ? trace(ray, 0) : trace(rescaled(ray, exponent), exponent);
}

/// The given rays; a rescaled copy when any has an unusual length.
class UsualRays {
  public:
    explicit UsualRays(std::span<const Ray> rays) : given_(rays) {
        for (const Ray& ray : rays) unusual_ = unusual_ || unusual_exponent(ray.direction) != 0;
        if (!unusual_) return;
        copies_.reserve(rays.size());
        for (const Ray& ray : rays) {
            copies_.push_back(rescaled(ray, unusual_exponent(ray.direction)));
        }
    }
    [[nodiscard]] std::span<const Ray> rays() const {
        return unusual_ ? std::span<const Ray>(copies_) : given_;
    }
    /// Converts t to the units of the given rays.
    void restore(std::span<Hit> hits) const {
        for (std::size_t i = 0; unusual_ && i < hits.size(); ++i) {
            hits[i].t = std::ldexp(hits[i].t, -unusual_exponent(given_[i].direction));
        }
    }

  private:
    std::span<const Ray> given_;
    std::vector<Ray> copies_;
    bool unusual_ = false;
};

void check_columns(const RayColumns& rays) {
    if (rays.is_complete()) return;
    throw Error(ErrorKind::Usage, "the columns of a batch of " + std::to_string(rays.size()) +
                                      " rays have different lengths");
}

/// Calls f(column) for every column.
template <class F>
void for_each_column(const TracedColumns& hits, F&& f) {
    f(hits.t);
    f(hits.u);
    f(hits.v);
    f(hits.geometry);
    f(hits.primitive);
    f(hits.outermost);
}

/// True if no direction needs `rescaled`, for all that is known without its exponent.
bool are_usual(const RayColumns& rays) {
    const auto& [x, y, z] = rays.directions;
    bool usual = true;
    for (std::size_t i = 0; i < x.size(); ++i) {
        const float longest = std::max(std::max(std::abs(x[i]), std::abs(y[i])), std::abs(z[i]));
        usual &= longest == 0.0f || (longest >= static_cast<float>(kShortestDirection) &&
                                     longest <= static_cast<float>(kLongestDirection));
    }
    return usual;
}

/// Number of rays in columns whose ids are found together.
constexpr std::size_t kColumnBlock = 1024;

/// Calls trace(rays, first) with the rays of columns, in parts.
template <class Trace>
void convert(const RayColumns& columns, Trace&& trace) {
    std::vector<Ray> rays;
    for (std::size_t first = 0; first < columns.size(); first += rays.size()) {
        rays.resize(std::min(kColumnBlock, columns.size() - first));
        for (std::size_t i = 0; i < rays.size(); ++i) rays[i] = columns.ray(first + i);
        trace(std::span<const Ray>(rays), first);
    }
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
        throw Error(ErrorKind::Usage,
                    std::string("only the accelerator ") + kDefaultAccelerator + " can be stored");
    }
    wide->save(file);
}

bool Tracer::intersect(const Ray& ray, Hit& hit, RayMask mask) const {
    return with_usual(ray, [&](const Ray& usual, int exponent) {
        const bool found = aggregate_->closest(usual, hit, {nullptr, mask});
        if (exponent != 0) hit.t = std::ldexp(hit.t, -exponent);
        return found;
    });
}

bool Tracer::occluded(const Ray& ray, RayMask mask) const {
    return with_usual(ray, [&](const Ray& usual, int) {
        return aggregate_->occluded(usual, {nullptr, mask});
    });
}

void Tracer::all_hits(const Ray& ray, std::vector<Hit>& hits, RayMask mask) const {
    hits.clear();
    append_hits(ray, hits, mask);
}

void Tracer::append_hits(const Ray& ray, std::vector<Hit>& hits, RayMask mask) const {
    const std::size_t before = hits.size();
    with_usual(ray, [&](const Ray& usual, int exponent) {
        aggregate_->all_hits(usual, hits, {nullptr, mask});
        if (exponent == 0) return;
        for (std::size_t i = before; i < hits.size(); ++i) {
            hits[i].t = std::ldexp(hits[i].t, -exponent);
        }
    });
}

void Tracer::intersect(std::span<const Ray> rays, std::span<Hit> hits, RayMask mask,
                       Coherence coherence) const {
    check_lengths(rays.size(), hits.size());
    const UsualRays usual(rays);
    aggregate_->closest_batch(usual.rays(), hits, {nullptr, mask}, coherence);
    usual.restore(hits);
}

void Tracer::occluded(std::span<const Ray> rays, std::span<bool> occluded, RayMask mask,
                      Coherence coherence) const {
    check_lengths(rays.size(), occluded.size());
    aggregate_->occluded_batch(UsualRays(rays).rays(), occluded, {nullptr, mask}, coherence);
}

void Tracer::intersect(const RayColumns& rays, const TracedColumns& hits, RayMask mask,
                       Coherence coherence) const {
    check_columns(rays);
    for_each_column(hits, [&](auto column) {
        if (!column.empty()) check_lengths(rays.size(), column.size());
    });
    if (aggregate_->primitives().instances.empty() && are_usual(rays)) {
        return intersect_usual(rays, hits, mask, coherence);
    }
    std::vector<Hit> found;
    convert(rays, [&](std::span<const Ray> some, std::size_t first) {
        found.resize(some.size());
        intersect(some, found, mask, coherence);
        const HitColumns plain{hits.t, hits.u, hits.v};
        for (std::size_t i = 0; i < found.size(); ++i) {
            plain.set(first + i, found[i]);
            set_ids(hits, first + i, found[i]);
        }
    });
}

void Tracer::intersect_usual(const RayColumns& rays, const TracedColumns& hits, RayMask mask,
                             Coherence coherence) const {
    const HitColumns plain{hits.t, hits.u, hits.v};
    if (hits.geometry.empty() && hits.primitive.empty() && hits.outermost.empty()) {
        return aggregate_->closest_columns(rays, plain, {nullptr, mask}, coherence);
    }
    std::array<PrimitiveId, kColumnBlock> ids;
    Hit hit;
    for (std::size_t first = 0; first < rays.size(); first += kColumnBlock) {
        const std::size_t count = std::min(kColumnBlock, rays.size() - first);
        HitColumns here = plain.part(first, count);
        here.primitive = std::span(ids).first(count);
        aggregate_->closest_columns(rays.part(first, count), here, {nullptr, mask}, coherence);
        for (std::size_t i = 0; i < count; ++i) {
            hit.primitive = ids[i];
            set_ids(hits, first + i, hit);
        }
    }
}

void Tracer::set_ids(const TracedColumns& hits, std::size_t i, const Hit& hit) const {
    HitIds found{kNoGeometry, kNoTriangle, kNoGeometry};
    if (hit.found()) found = ids(hit);
    if (!hits.geometry.empty()) hits.geometry[i] = found.geometry;
    if (!hits.primitive.empty()) hits.primitive[i] = found.primitive;
    if (!hits.outermost.empty()) hits.outermost[i] = found.outermost;
}

void Tracer::occluded(const RayColumns& rays, std::span<bool> occluded, RayMask mask,
                      Coherence coherence) const {
    check_columns(rays);
    check_lengths(rays.size(), occluded.size());
    if (are_usual(rays)) {
        return aggregate_->occluded_columns(rays, occluded, {nullptr, mask}, coherence);
    }
    convert(rays, [&](std::span<const Ray> some, std::size_t first) {
        this->occluded(some, occluded.subspan(first, some.size()), mask, coherence);
    });
}

void Tracer::all_hits(std::span<const Ray> rays, HitLists& lists, RayMask mask) const {
    lists.hits.clear();
    lists.ends.clear();
    lists.ends.reserve(rays.size());
    for (const Ray& ray : rays) {
        append_hits(ray, lists.hits, mask);
        lists.ends.push_back(lists.hits.size());
    }
}

Tracer Tracer::of(const Scene& scene) {
    if (!scene.aggregate) throw Error(ErrorKind::Usage, "the scene has no aggregate");
    return {scene.aggregate, scene.census.analytic_shapes + scene.census.triangles,
            static_cast<std::size_t>(scene.census.instance_depth)};
}

HitIds Tracer::ids(const Hit& hit) const {
    HitIds ids;
    const PrimitiveTable* table = &aggregate_->primitives();
    for (std::size_t level = hit.path.size(); level-- > 0;) {
        check_id(*table, hit.path[level], true);
        table = &table->instances[table->index(hit.path[level])].aggregate->primitives();
    }
    check_id(*table, hit.primitive, false);
    const std::uint32_t kind = table->kind(hit.primitive);
    const std::uint32_t index = static_cast<std::uint32_t>(hit.primitive) - table->first(kind);
    if (kind == kTriangleKind) ids.primitive = index - table->mesh_of(index).first_triangle;
    const HitParts parts = parts_of(*aggregate_, hit);
    ids.geometry = GeometryId{parts.part};
    ids.outermost = GeometryId{parts.instance};
    return ids;
}

void Tracer::surface(const Ray& ray, const Hit& hit, Surface& surface) const {
    const int exponent = unusual_exponent(ray.direction);
    if (exponent == 0) return set_surface(*aggregate_, ray, hit, CoordinateNeed::none(), surface);
    const Ray usual = rescaled(ray, exponent);
    const UsualHit found = usual_hit(*aggregate_, usual, hit, exponent);
    set_surface(*aggregate_, usual, found.hit, CoordinateNeed::none(), surface);
    cover_others(*aggregate_, usual, found, surface);
}

Vec3 Tracer::normal(const Ray& ray, const Hit& hit, Surface& scratch) const {
    const PrimitiveTable& table = aggregate_->primitives();
    if (hit.path.empty() && table.kind(hit.primitive) == kTriangleKind) {
        const std::uint32_t index = table.index(hit.primitive);
        const PlacedMesh& placed = table.mesh_of(index);
        if (!placed.motion) {
            const Vec3 normal = triangle_normal(*placed.mesh, index - placed.first_triangle);
            scratch.normal = placed.mirrored ? -normal : normal;
            aggregate_->complete(ray, hit.t, hit.primitive, scratch);
            return scratch.normal;
        }
    }
    surface(ray, hit, scratch);
    return scratch.normal;
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
    static_cast<Surface&>(details) = with_usual(ray, [&](const Ray& usual, int exponent) {
        if (exponent == 0) return surface_at(*aggregate_, usual, hit);
        const UsualHit found = usual_hit(*aggregate_, usual, hit, exponent);
        Surface surface = surface_at(*aggregate_, usual, found.hit);
        cover_others(*aggregate_, usual, found, surface);
        return surface;
    });
    details.geometry = GeometryId{details.part};
    if (table->kind(hit.primitive) == kTriangleKind) {
        const std::uint32_t triangle = table->index(hit.primitive);
        details.primitive = triangle - table->mesh_of(triangle).first_triangle;
    }
    return details;
}

}  // namespace alhazen
