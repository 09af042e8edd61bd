#include "alhazen/renderers/volumes/shadow_batch.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "alhazen/renderers/core/coincident_surfaces.h"
#include "alhazen/renderers/core/local_shading.h"
#include "alhazen/renderers/volumes/exact_optics.h"
#include "alhazen/renderers/volumes/volume_bounds.h"

namespace alhazen {

namespace {

using ShadowTint = ShadingConventions::ShadowTint;

/// Rays per cast: enough to fill the stream kernel, and few enough for the cache.
constexpr std::size_t kMostRays = 512;
/// Crossings are searched on all rays if more than one ray in `kFewMeet` hits something.
constexpr std::uint64_t kFewMeet = 4;

}  // namespace

ShadowBatch::ShadowBatch(const Scene& scene, RayCounters& counters, TraversalStats* stats)
    : scene_(scene),
      count_(counters[RayKind::Shadow]),
      stats_(stats),
      opaque_(scene.all_block_light()),
      constant_(scene),
      rays_(std::make_unique<Ray[]>(kMostRays)),
      waiting_(std::make_unique<Waiting[]>(kMostRays)),
      met_(std::make_unique<bool[]>(kMostRays)),
      sorted_met_(std::make_unique<bool[]>(kMostRays)) {
    expect(Coherence::Any);
}

void ShadowBatch::expect(Coherence coherence) {
    coherence_ = coherence;
    at_once_ = !scene_.has_motion && scene_.conventions.shading.shadow_tint != ShadowTint::None &&
               !scene_.aggregate->gains_by_batches(Coherence::Any) &&
               !scene_.aggregate->gains_by_batches(coherence);
}

Rgb ShadowBatch::arriving(const LeavingRays& surface, const LightSample& light, const Path& path) {
    const Ray ray = onward_ray(scene_.conventions.shading, surface, light.to_light, light.distance);
    ++count_.cast;
    return let_through(ray, path, !opaque_ || scene_.aggregate->occluded(ray, query()));
}

void ShadowBatch::add(const LeavingRays& surface, const LightSample& light, const Rgb& fraction,
                      const Path& path, Rgb& sum, std::size_t number) {
    if (scene_.conventions.shading.shadow_tint == ShadowTint::None) {
        sum += light.intensity * fraction;
        return;
    }
    if (count_waiting_ == kMostRays) finish();
    rays_[count_waiting_] =
        onward_ray(scene_.conventions.shading, surface, light.to_light, light.distance);
    waiting_[count_waiting_] = {&sum, &path, light.intensity, fraction, number};
    ++count_waiting_;
}

void ShadowBatch::finish() {
    if (count_waiting_ == 0) return;
    const std::span<bool> met(met_.get(), count_waiting_);
    if (asks_first()) {
        find_met(met);
    } else {
        std::fill(met.begin(), met.end(), true);
    }
    count_.cast += count_waiting_;
    for (std::size_t i = 0; i < count_waiting_; ++i) {
        const Waiting& w = waiting_[i];
        const Rgb through = let_through(rays_[i], *w.path, met[i]);
        if (!through.is_black()) *w.sum += through * w.intensity * w.fraction;
    }
    count_waiting_ = 0;
}

void ShadowBatch::find_met(std::span<bool> met) {
    if (!scene_.has_motion) {
        if (coherence_ == Coherence::Coherent) return find_met_by_light(met);
        return scene_.aggregate->occluded_batch(rays(), met, query(), coherence_);
    }
    times_.clear();
    for (const Waiting& w : waiting()) times_.push_back(w.path->time);
    scene_.aggregate->occluded_batch_at(rays(), times_, met, query(), coherence_);
}

void ShadowBatch::find_met_by_light(std::span<bool> met) {
    const Aggregate& aggregate = *scene_.aggregate;
    const std::size_t light = waiting().front().light;
    if (std::all_of(waiting().begin(), waiting().end(),
                    [&](const Waiting& w) { return w.light == light; })) {
        return aggregate.occluded_batch(rays(), met, query(), coherence_);
    }
    // Counting sort: `begins_` holds the number of rays of each light, then the place of its next
    // ray.
    begins_.assign(scene_.lights.size(), 0);
    for (const Waiting& w : waiting()) ++begins_[w.light];
    for (std::uint32_t before = 0; std::uint32_t & count : begins_) {
        before += std::exchange(count, before);
    }
    sorted_.resize(kMostRays);
    places_.resize(kMostRays);
    for (std::size_t i = 0; const Waiting& w : waiting()) {
        const std::uint32_t place = begins_[w.light]++;
        sorted_[place] = rays_[i];
        places_[i++] = place;
    }
    const std::span<bool> found(sorted_met_.get(), met.size());
    for (std::size_t number = 0, first = 0; number < begins_.size(); ++number) {
        const std::size_t count = begins_[number] - first;
        if (count == 0) continue;
        aggregate.occluded_batch(std::span<const Ray>(sorted_).subspan(first, count),
                                 found.subspan(first, count), query(), coherence_);
        first += count;
    }
    for (std::size_t i = 0; i < met.size(); ++i) met[i] = found[places_[i]];
}

/// True if it is faster to find first which rays hit anything, and crossings only for these. False
/// while tests are counted: counts must not depend on earlier rays.
bool ShadowBatch::asks_first() const {
    if (opaque_) return true;
    return stats_ == nullptr && kFewMeet * count_.hit <= count_.cast &&
           scene_.aggregate->gains_by_batches(coherence_);
}

/// Transmittance along the ray. `met`: the ray hits some surface.
Rgb ShadowBatch::let_through(const Ray& ray, const Path& path, bool met) {
    if (opaque_) {
        count_.hit += met;
        return met ? Rgb{0, 0, 0} : Rgb{1, 1, 1};
    }
    crossings_.clear();
    // A hit on the back of a single-sided surface is no crossing.
    const bool blocked = met && scene_.aggregate->shadowed(ray, crossings_, query(path.time));
    count_.hit += blocked || !crossings_.empty();
    if (blocked) return {};
    if (optics_ != nullptr) return tint_by_optics(ray, path);
    const bool in_air = !path.inside && path.medium == TintedMedia::kOutside;
    return crossings_.empty() && in_air ? Rgb{1, 1, 1} : tint_of_crossings(ray, path);
}

const Surface& ShadowBatch::crossed(const Ray& ray, const Hit& hit, float time) {
    set_surface(*scene_.aggregate, ray, hit, CoordinateNeed::of(scene_.reads_coordinates), surface_,
                time);
    return surface_;
}

const MaterialSample& ShadowBatch::material_of(const Surface& surface) {
    if (!surface.has_extras) {
        if (const MaterialSample* shared = constant_.find(surface.materials[0])) return *shared;
    }
    own_ = material_at(scene_, surface, {}, {surface.point, {}, {}});
    return own_;
}

Rgb ShadowBatch::tint_of_crossings(const Ray& ray, const Path& path) {
    Rgb tint{1, 1, 1};
    start_inside(scene_.conventions.shading, *tinted_, path, volumes_);
    double last = 0.0;
    const double min_distance = scene_.conventions.shading.min_distance;
    double met = -min_distance;  // the last surface that tints
    bool tints = true;
    bool in_wall = false;  // between the two crossings of a wall, which are one boundary
    for (const Hit& hit : crossings_) {
        if (!in_wall) tints = !(hit.t - met < min_distance);
        if (tints) met = hit.t;
        const Surface& surface = crossed(ray, hit, path.time);
        const MaterialSample* material = &material_of(surface);
        if (material->coverage == 0.0) continue;
        bool leaving = dot(ray.direction, surface.normal) >= 0.0;
        bool closed = scene_.is_closed(surface.part);
        const MaterialSample* medium = material;
        if (const SurfaceMedia& media = surface.media; media.before || media.after) {
            const bool wall = media.before && media.after;
            leaving = media.before && !in_wall;
            in_wall = wall && leaving;
            medium_ = medium_at(scene_, surface, leaving ? *media.before : *media.after);
            medium = &medium_;
            closed = true;
            if (wall) material = medium;
        } else if (surface.volume) {
            medium_ = medium_at(scene_, surface, *surface.volume);
            medium = &medium_;
        }
        // Light passes through the back of a single-sided surface.
        if (!leaving && is_unseen_from_behind(*material)) continue;
        const Crossing crossing = cross(scene_.conventions.shading, surface, *material, *medium,
                                        leaving, closed, hit.t - last, volumes_);
        tint = tint * crossing.way;
        Rgb through = tints ? crossing.body * crossing.surface : crossing.body;
        if (material->coverage < 1.0) {
            const double open = 1.0 - material->coverage;
            through = Rgb{open, open, open} + material->coverage * through;
        }
        tint = tint * through;
        if (tint.is_black()) return tint;
        if (!medium->physical || !medium->thin) last = hit.t;
    }
    if (std::isfinite(ray.t_max)) tint = tint * volumes_.through(ray.t_max - last);
    return tint;
}

Rgb ShadowBatch::tint_by_optics(const Ray& ray, const Path& path) {
    const std::size_t mark = optics_->mark();
    const double min_distance = scene_.conventions.shading.min_distance;
    Rgb tint{1, 1, 1};
    std::uint32_t medium =
        scene_.has_masks ? optics_->seen_by_shadow_rays(path.medium) : path.medium;
    double last = 0.0, met = -min_distance;
    together_.clear();
    for (std::size_t i = 0; i < crossings_.size(); ++i) {
        const Hit& crossing = crossings_[i];
        const Surface& surface = crossed(ray, crossing, path.time);
        const std::uint64_t number = volume_number(surface);
        if (together_.has(number, crossing.t)) continue;
        const bool tints = !(crossing.t - met < min_distance);
        if (tints) met = crossing.t;
        const bool wall = is_wall(surface);
        if (wall) medium_ = medium_at(scene_, surface, *surface.media.after);
        const MaterialSample& material = wall ? medium_ : material_of(surface);
        const bool entering = dot(ray.direction, surface.normal) < 0.0;
        // Light passes through the back of a single-sided surface.
        if (material.coverage == 0.0 || (entering && is_unseen_from_behind(material))) continue;
        const double reach = CoincidentSurfaces::reach(surface, ray.direction);
        const bool alone = i + 1 == crossings_.size() || crossings_[i + 1].t - crossing.t > reach;
        others_.clear();
        if (!alone) others_ = optics_->faces_at(ray, crossing, path.time);
        together_.add(others_, crossing.t, reach);
        if (wall) together_.add_wall(number);
        auto [through, behind] = optics_->cross(surface, material, ray.direction, medium, others_);
        if (scene_.conventions.shading.shadow_tint == ShadowTint::Opaque) through = {};
        if (!tints) through = {1, 1, 1};
        const double open = 1.0 - material.coverage;
        tint = tint * (Rgb{open, open, open} + material.coverage * through) *
               transmittance(optics_->absorption(medium), crossing.t - last);
        medium = behind;
        last = crossing.t;
    }
    if (std::isfinite(ray.t_max)) {
        tint = tint * transmittance(optics_->absorption(medium), ray.t_max - last);
    }
    optics_->release(mark);
    return tint;
}

}  // namespace alhazen
