#include "alhazen/renderers/light_transport/connection_batch.h"

#include <algorithm>
#include <cmath>

#include "alhazen/renderers/core/coincident_surfaces.h"
#include "alhazen/renderers/core/local_shading.h"
#include "alhazen/renderers/light_transport/scatter_point.h"
#include "alhazen/renderers/volumes/volume_bounds.h"

namespace alhazen {

namespace {

/// The transmittance of a medium, absorption only; null: 1.
Spectrum left_by(const Medium* medium, double length, const Wavelengths& waves) {
    if (medium == nullptr || medium->absorption.is_black()) return Spectrum::all(1);
    return transmittance(waves.absorption(medium->absorption), length);
}

}  // namespace

ConnectionBatch::ConnectionBatch(const Scene& scene, RayCounters& counters, TraversalStats* stats,
                                 RayMask sees)
    : scene_(scene),
      count_(counters[RayKind::Shadow]),
      stats_(stats),
      connecting_(sees),
      media_(scene),
      faces_(scene),
      has_single_sided_(std::any_of(scene.materials.begin(), scene.materials.end(),
                                    [](const Material& m) { return !m.double_sided; })),
      rays_(kMostRays),
      met_(std::make_unique<bool[]>(kMostRays)) {
    waiting_.reserve(kMostRays);
}

void ConnectionBatch::add(const Ray& ray, float time, const MediumStack& media,
                          const Wavelengths& waves, const Spectrum& light, Spectrum& sum) {
    if (waiting_.size() == kMostRays) finish();
    const MediumStack& around = seen_of(media);
    const Medium* const medium = around.here();
    // If volumes are followed, this one may end along the ray.
    const Spectrum left =
        media_.are_followed() || medium == nullptr || medium->absorption.is_black()
            ? light
            : light * left_by(medium, ray.t_max * length(ray.direction), waves);
    if (left.is_black()) return;
    if (media_.are_followed()) around_.push_back(around);
    rays_[waiting_.size()] = ray;
    times_.push_back(time);
    waiting_.push_back({left, &waves, &sum});
}

void ConnectionBatch::add_waiting(float time, const Spectrum& light, Spectrum& sum) {
    if (media_.are_followed()) around_.emplace_back();
    times_.push_back(time);
    waiting_.push_back({light, &kColorChannels, &sum});
}

void ConnectionBatch::finish() {
    if (waiting_.empty()) return;
    const std::span<bool> met(met_.get(), waiting_.size());
    find_met(met);
    count_.cast += met.size();
    for (std::size_t i = 0; i < met.size(); ++i) {
        count_.hit += met[i];
        const Waiting& w = waiting_[i];
        if (media_.are_followed()) {
            *w.sum += through_volumes(rays_[i], times_[i], RayKind::Shadow, around_[i], *w.waves,
                                      met[i], nullptr) *
                      w.light;
        } else if (!met[i]) {
            *w.sum += w.light;
        } else if (!scene_.all_opaque) {
            *w.sum += through_surfaces(rays_[i], times_[i], RayKind::Shadow, *w.waves) * w.light;
        }
    }
    times_.clear();
    around_.clear();
    waiting_.clear();
}

const MediumStack& ConnectionBatch::seen_of(const MediumStack& media) {
    if (!scene_.has_masks || media.empty()) return media;
    seen_ = media;
    seen_.keep_seen_by(connecting_);
    return seen_;
}

void ConnectionBatch::find_met(std::span<bool> met) {
    const std::span<const Ray> rays = std::span(rays_).first(met.size());
    if (scene_.has_motion) {
        scene_.aggregate->occluded_batch_at(rays, times_, met, query(0.0f), Coherence::Any);
    } else {
        scene_.aggregate->occluded_batch(rays, met, query(0.0f), Coherence::Any);
    }
}

Spectrum ConnectionBatch::passing(const Ray& ray, float time, const MediumStack& media,
                                  const Wavelengths& waves, FreeFlight* flight) {
    return passing(ray, time, RayKind::Shadow, seen_of(media), waves, flight);
}

Spectrum ConnectionBatch::seen(const Ray& from_eye, float time, const MediumStack& media,
                               const Wavelengths& waves, FreeFlight* flight) {
    return passing(from_eye, time, RayKind::Eye, media, waves, flight);
}

Spectrum ConnectionBatch::passing(const Ray& ray, float time, RayKind kind,
                                  const MediumStack& media, const Wavelengths& waves,
                                  FreeFlight* flight) {
    ++count_.cast;
    const bool met = scene_.aggregate->occluded(ray, query(time, kind));
    count_.hit += met;
    if (media_.are_followed()) return through_volumes(ray, time, kind, media, waves, met, flight);
    if (met && scene_.all_opaque) return {};
    const Spectrum left = left_by(media.here(), ray.t_max * length(ray.direction), waves);
    return met ? left * through_surfaces(ray, time, kind, waves) : left;
}

bool ConnectionBatch::find_crossings(const Ray& ray, float time, RayKind kind) {
    crossings_.clear();
    if (has_single_sided_ && kind == RayKind::Eye) {
        // `shadowed` asks on which side a ray leaves a single-sided surface, towards the light;
        // this ray begins at the eye, and sees the side on which it arrives.
        scene_.aggregate->all_hits(ray, crossings_, query(time, kind));
        return true;
    }
    if (scene_.aggregate->shadowed(ray, crossings_, query(time, kind))) return false;
    if (has_single_sided_) {
        // The backs of single-sided surfaces are missing in `crossings_`.
        if (crossings_.empty()) return false;
        crossings_.clear();
        scene_.aggregate->all_hits(ray, crossings_, query(time, kind));
    }
    return true;
}

Spectrum ConnectionBatch::through_surfaces(const Ray& ray, float time, RayKind kind,
                                           const Wavelengths& waves) {
    if (!find_crossings(ray, time, kind)) return {};
    Spectrum share = Spectrum::all(1);
    for (const Hit& crossing : crossings_) {
        share = share * through(ray, time, kind, crossing, waves, nullptr);
        if (share.is_black()) break;
    }
    return share;
}

Spectrum ConnectionBatch::through_volumes(const Ray& ray, float time, RayKind kind,
                                          const MediumStack& media, const Wavelengths& waves,
                                          bool met, FreeFlight* flight) {
    if (met && (scene_.all_opaque || !find_crossings(ray, time, kind))) return {};
    MediumStack around = media;
    const double scale = length(ray.direction);
    Spectrum share = Spectrum::all(1);
    double from = 0.0;
    const auto pass_volume = [&](double to) {
        const Medium* const medium = around.here();
        const Extinction taken = media_.extinction(medium);
        if (!taken.is_black()) {
            const Spectrum extinction = taken.of(waves);
            share = share * transmittance(extinction, (to - from) * scale);
            if (flight != nullptr && !taken.scattered.is_black()) {
                flight->add(extinction, (to - from) * scale);
            }
        }
        from = to;
    };
    if (met) {
        crossed_.clear();
        last_face_ = -kInfinity;
        for (const Hit& crossing : crossings_) {
            if (is_crossed(ray, crossing, time)) continue;
            pass_volume(crossing.t);
            share = share * through(ray, time, kind, crossing, waves, &around);
            if (share.is_black()) return share;
        }
    }
    pass_volume(ray.t_max);
    return share;
}

bool ConnectionBatch::is_crossed(const Ray& ray, const Hit& hit, float time) {
    if (!crossed_.may_have(hit.t)) return false;
    set_surface(*scene_.aggregate, ray, hit, CoordinateNeed::none(), surface_, time);
    return crossed_.has(volume_number(surface_), hit.t);
}

Spectrum ConnectionBatch::through(const Ray& ray, float time, RayKind kind, const Hit& crossing,
                                  const Wavelengths& waves, MediumStack* media) {
    ShadingPoint point;
    const bool inside = media != nullptr && !media->empty();
    const Arrival arrival{inside, 0.0, time, kind != RayKind::Eye};
    set_shading_point(scene_, ray, crossing, arrival, {}, point);
    if (media != nullptr) {
        // Half: the last face must not be found again by rounding.
        const double since = length(ray.direction) * (crossing.t - last_face_);
        point.way = std::min(point.way, 0.5 * since);
        if (!point.material->thin) last_face_ = crossing.t;
        faces_.find_next_to_sheets(point, ray.direction, arrival, mask_for(kind));
        crossed_.add(faces_.others(), crossing.t,
                     CoincidentSurfaces::reach(point.surface, ray.direction));
        if (is_wall(point.surface)) crossed_.add_wall(volume_number(point.surface));
    }
    const double coverage = point.material->coverage;
    if (coverage == 0.0 && media == nullptr) return Spectrum::all(1);
    Spectrum covered;
    if (point.material->thin || media != nullptr) {
        ScatterPoint scatter;
        scatter.set(scene_, point, media != nullptr ? *media : MediumStack(), waves, false, nullptr,
                    media != nullptr ? &faces_.others() : nullptr);
        covered = scatter.straight();
        if (scatter.is_null_boundary()) {
            scatter.cross(*media);
        } else if (media != nullptr && coverage < 1.0) {
            scatter.cross_opening(*media);
        }
    }
    return Spectrum::all(1.0 - coverage) + coverage * covered;
}

}  // namespace alhazen
