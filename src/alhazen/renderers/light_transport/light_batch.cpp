#include "alhazen/renderers/light_transport/light_batch.h"

#include <algorithm>
#include <cmath>

#include "alhazen/renderers/core/local_shading.h"
#include "alhazen/renderers/light_transport/scatter_point.h"

namespace alhazen {

namespace {

/// Rays per cast: enough to fill the stream kernel, few enough to stay in the cache.
constexpr std::size_t kMostLightRays = 512;

}  // namespace

LightBatch::LightBatch(const Scene& scene, RayCounters& counters, TraversalStats* stats)
    : scene_(scene),
      count_(counters[RayKind::Shadow]),
      stats_(stats),
      has_single_sided_(std::any_of(scene.materials.begin(), scene.materials.end(),
                                    [](const Material& m) { return !m.double_sided; })),
      met_(std::make_unique<bool[]>(kMostLightRays)) {
    rays_.reserve(kMostLightRays);
    waiting_.reserve(kMostLightRays);
}

void LightBatch::add(const Ray& ray, float time, const Extinction& extinction,
                     const Wavelengths& waves, const Spectrum& light, Spectrum& sum) {
    if (rays_.size() == kMostLightRays) finish();
    const Spectrum left =
        extinction.is_black()
            ? light
            : light * transmittance(extinction.of(waves), ray.t_max * length(ray.direction));
    if (left.is_black()) return;
    rays_.push_back(ray);
    times_.push_back(time);
    waiting_.push_back({left, &waves, &sum});
}

void LightBatch::finish() {
    if (rays_.empty()) return;
    const std::span<bool> met(met_.get(), rays_.size());
    find_met(met);
    count_.cast += rays_.size();
    for (std::size_t i = 0; i < rays_.size(); ++i) {
        count_.hit += met[i];
        const Waiting& w = waiting_[i];
        if (!met[i]) {
            *w.sum += w.light;
        } else if (!scene_.all_opaque) {
            *w.sum += through_surfaces(rays_[i], times_[i], RayKind::Shadow, *w.waves) * w.light;
        }
    }
    rays_.clear();
    times_.clear();
    waiting_.clear();
}

void LightBatch::find_met(std::span<bool> met) {
    if (scene_.has_motion) {
        scene_.aggregate->occluded_batch_at(rays_, times_, met, query(0.0f), Coherence::Any);
    } else {
        scene_.aggregate->occluded_batch(rays_, met, query(0.0f), Coherence::Any);
    }
}

Spectrum LightBatch::passing(const Ray& ray, float time, const Extinction& extinction,
                             const Wavelengths& waves) {
    return passing(ray, time, RayKind::Shadow, extinction, waves);
}

Spectrum LightBatch::seen(const Ray& from_eye, float time, const Extinction& extinction,
                          const Wavelengths& waves) {
    return passing(from_eye, time, RayKind::Eye, extinction, waves);
}

Spectrum LightBatch::passing(const Ray& ray, float time, RayKind kind, const Extinction& extinction,
                             const Wavelengths& waves) {
    ++count_.cast;
    const Spectrum left = extinction.is_black() ? Spectrum::all(1)
                                                : transmittance(extinction.of(waves),
                                                                ray.t_max * length(ray.direction));
    if (!scene_.aggregate->occluded(ray, query(time, kind))) return left;
    ++count_.hit;
    return scene_.all_opaque ? Spectrum{} : left * through_surfaces(ray, time, kind, waves);
}

Spectrum LightBatch::through_surfaces(const Ray& ray, float time, RayKind kind,
                                      const Wavelengths& waves) {
    crossings_.clear();
    if (scene_.aggregate->shadowed(ray, crossings_, query(time, kind))) return {};
    if (has_single_sided_ && kind != RayKind::Eye) {
        // Their backs are no crossings.
        if (crossings_.empty()) return {};
        crossings_.clear();
        scene_.aggregate->all_hits(ray, crossings_, query(time, kind));
    }
    Spectrum share = Spectrum::all(1);
    for (const Hit& crossing : crossings_) {
        share = share * through(ray, time, kind, crossing, waves);
        if (share.is_black()) break;
    }
    return share;
}

Spectrum LightBatch::through(const Ray& ray, float time, RayKind kind, const Hit& crossing,
                             const Wavelengths& waves) const {
    ShadingPoint point;
    set_shading_point(scene_, ray, crossing, {false, 0.0, time, kind != RayKind::Eye}, {}, point);
    const double coverage = point.material->coverage;
    if (coverage == 0.0) return Spectrum::all(1);
    Spectrum covered;
    if (point.material->thin) {
        ScatterPoint scatter;
        scatter.set(scene_, point, {}, waves);
        covered = scatter.straight();
    }
    return Spectrum::all(1.0 - coverage) + coverage * covered;
}

}  // namespace alhazen
