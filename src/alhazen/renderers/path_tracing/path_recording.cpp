// The record of one path (RenderJob::path).

#include "alhazen/renderers/path_tracing/path_tracer.h"

namespace alhazen {

void PathTracer::begin_record() {
    recorded_ = kNoSample;
    // Paths with layers, polarisation or manifold search are not recorded.
    if (job_.path == nullptr || joins_apart() || manifold_ != nullptr) return;
    for (std::uint32_t i = 0; i < ids_.size(); ++i) {
        if (ids_[i].number == job_.path->sample) recorded_ = i;
    }
    if (recorded_ != kNoSample) job_.path->vertices.clear();
}

void PathTracer::record_ray(const EyePath& path, const Ray& ray, const ShadingPoint* point,
                            double t) {
    RecordedVertex vertex;
    vertex.kind = path.kind;
    vertex.ray = ray;
    vertex.throughput = waves(path).color(path.throughput);
    if (point == nullptr) {
        vertex.step = PathStep::Escaped;
    } else {
        vertex.t = t;
        vertex.has_surface = true;
        vertex.normal = point->surface.shading_normal;
        vertex.part = point->surface.part;
        vertex.material = static_cast<std::uint32_t>(point->surface.materials[0]);
    }
    job_.path->vertices.push_back(vertex);
    recorded_arrival_ = {};
}

Spectrum* PathTracer::record_shadow(const EyePath& path, const Ray& shadow, const Spectrum& light) {
    RecordedVertex* const vertex = recorded(path);
    if (vertex == nullptr) return nullptr;
    vertex->asked_light = true;
    vertex->shadow = shadow;
    vertex->offered = waves(path).color(light);
    return &recorded_arrival_;
}

void PathTracer::record_arrival() {
    const Wavelengths& waves = waves_of(recorded_);
    light_[recorded_] += recorded_arrival_;
    job_.path->vertices.back().arrived += waves.color(recorded_arrival_);
    recorded_arrival_ = {};
}

}  // namespace alhazen
