// Vertices of PathTracer in lanes: from the hits to shadow rays and next rays.

#include "alhazen/renderers/path_tracing/path_tracer.h"

namespace alhazen {

namespace {

Vec3 vector_of(const VertexLanes::Vectors& of, std::size_t lane) {
    return {of[0][lane], of[1][lane], of[2][lane]};
}
Spectrum spectrum_of(const VertexLanes::Spectra& of, std::size_t lane) {
    return {of[0][lane], of[1][lane], of[2][lane], of[3][lane]};
}
template <class V, std::size_t N>
void put(const V& v, std::size_t lane, VertexLanes::Numbers (&to)[N]) {
    for (std::size_t k = 0; k < N; ++k) to[k][lane] = v[static_cast<int>(k)];
}

}  // namespace

bool PathTracer::takes_into_lane(EyePath& path, const Ray& ray, const Hit& hit) {
    if (!uses_lanes_ || path.inside) return false;
    const PlainMeshes::Place place = plain_.find(hit);
    if (place.material == nullptr) return false;
    ++counters_[path.kind].hit;
    path.travelled += hit.t;
    path.cone = path.cone.from(hit.t);
    ++path.met;
    if (path.scatterings >= settings_.depth) return true;
    __builtin_prefetch(&place.mesh->mesh->triangles[place.triangle]);
    of_lanes_[in_lanes_++] = {.path = &path,
                              .material = place.material,
                              .mesh = place.mesh,
                              .triangle = place.triangle,
                              .ray = &ray,
                              .u = hit.u,
                              .v = hit.v};
    if (in_lanes_ == VertexLanes::kMost) scatter_lanes();
    return true;
}

void PathTracer::fill_lanes() {
    const std::span<const LaneVertex> vertices = std::span(of_lanes_).first(in_lanes_);
    // Large meshes are not in the cache.
    for (const LaneVertex& vertex : vertices) {
        const TriangleMesh& mesh = *vertex.mesh->mesh;
        for (const std::uint32_t corner : mesh.triangles[vertex.triangle]) {
            __builtin_prefetch(&mesh.positions[corner]);
        }
    }
    for (std::size_t lane = 0; const LaneVertex& vertex : vertices) {
        ShapeHit hit;
        hit.u = vertex.u;
        hit.v = vertex.v;
        lanes_.triangles.set(lane, *vertex.mesh->mesh, vertex.triangle, hit, vertex.mesh->mirrored);
        put(vertex.ray->direction, lane, lanes_.ray);
        put(vertex.path->throughput, lane, lanes_.throughput);
        put(vertex.material->matt, lane++, lanes_.matt);
    }
}

void PathTracer::draw_numbers() {
    using enum PathRandomness::BouncePair;
    LightCallLanes& calls = draws_.calls();
    // Most paths of a batch have the same number of bounces.
    int bounce = -1;
    const Vec2 *places = nullptr, *directions = nullptr, *chosen = nullptr;
    for (std::size_t lane = 0; lane < in_lanes_; ++lane) {
        const EyePath& path = *of_lanes_[lane].path;
        const std::uint32_t sample = path.sample;
        if (path.drawn != bounce) {
            bounce = path.drawn;
            places = random_.drawn(bounce, kLight);
            directions = random_.drawn(bounce, kDirection);
            chosen = chooses_light_ ? random_.drawn(bounce, kChoices) : nullptr;
        }
        const Vec2 place = places ? places[sample] : random_.draw(sample, bounce, kLight);
        const Vec2 u = directions ? directions[sample] : random_.draw(sample, bounce, kDirection);
        if (chooses_light_) {
            const Vec2 both = chosen ? chosen[sample] : random_.draw(sample, bounce, kChoices);
            lobe_choices_[lane] = both.x;
            calls.choice[lane] = both.y;
        }
        calls.u[0][lane] = place.x;
        calls.u[1][lane] = place.y;
        lanes_.u[0][lane] = u.x;
        lanes_.u[1][lane] = u.y;
    }
}

void PathTracer::scatter_lanes() {
    if (in_lanes_ == 0) return;
    VertexLanes& v = lanes_;
    fill_lanes();
    v.find_frames(in_lanes_, draws_.calls());
    draw_numbers();
    draws_.draw(in_lanes_);
    const LightDrawLanes& lights = draws_.results();
    v.scatter(lights);
    bool any_rough = false;
    for (std::size_t lane = 0; lane < in_lanes_; ++lane) {
        const PlainMaterial* const material = of_lanes_[lane].material;
        if (material->is_matt) continue;
        if (const auto& rough = material->rough[v.entering >> lane & 1u]) {
            any_rough = true;
            const double choice =
                chooses_light_ ? lobe_choices_[lane] : choices(*of_lanes_[lane].path, true).x;
            rough_.set(lane, *rough, choice);
        } else {
            scatter_other(lane);
        }
    }
    if (any_rough) rough_.scatter(v);
    v.weigh(lights);
    for_each_lane(v.lit, [&](std::size_t lane) {
        const EyePath& path = *of_lanes_[lane].path;
        const double distance = lights.distance[lane];
        const Ray shadow{vector_of(v.origin, lane), vector_of(lights.to_light, lane),
                         LeavingRays::kBeyondZero,
                         end_before(distance, most_beside_, lights.facing[lane])};
        const Spectrum shown = limited(spectrum_of(v.light, lane), path.scatterings + 1);
        if (most_beside_ > kMostBeside * distance) [[unlikely]] {
            return add_beside(lane, shadow, shown);
        }
        shadows_.add_outside(shadow, path.time, shown, light_[path.sample]);
    });
    for_each_lane(v.sampled, [&](std::size_t lane) { leave_lane(lane); });
    draws_.clear();
    v.triangles.clear();
    in_lanes_ = 0;
}

void PathTracer::add_beside(std::size_t lane, const Ray& shadow, const Spectrum& shown) {
    const EyePath& path = *of_lanes_[lane].path;
    const LightDrawLanes& lights = draws_.results();
    const Ray aimed = ray_to_light(lights_, vector_of(lanes_.triangles.point, lane), shadow,
                                   lights.distance[lane], lights.places[lane], lights.facing[lane]);
    shadows_.add_outside(aimed, path.time, shown, light_[path.sample]);
}

void PathTracer::scatter_other(std::size_t lane) {
    VertexLanes& v = lanes_;
    EyePath* const path = of_lanes_[lane].path;
    const PlainMaterial* const material = of_lanes_[lane].material;
    const Bsdf& bsdf = material->bsdfs[v.entering >> lane & 1u];
    const Vec3 view = vector_of(v.view, lane);
    if ((v.lit >> lane & 1u) != 0) {
        const Vec3 to_light = vector_of(v.to_light, lane);
        put(to_light.z * bsdf.value(view, to_light, Transport::Radiance), lane, v.value);
        v.density[lane] = bsdf.density(view, to_light);
    }
    const double choice = choices(*path, bsdf.chooses()).x;
    const std::optional<BsdfSample> drawn =
        bsdf.sample(view, choice, {v.u[0][lane], v.u[1][lane]}, Transport::Radiance);
    if (!drawn) {
        v.sampled &= ~(1u << lane);
        return;
    }
    put(drawn->direction, lane, v.next);
    put(drawn->weight, lane, v.next_weight);
    v.next_density[lane] = drawn->density;
}

void PathTracer::leave_lane(std::size_t lane) {
    const VertexLanes& v = lanes_;
    EyePath& path = *of_lanes_[lane].path;
    path.throughput = spectrum_of(v.throughput, lane);
    ++path.drawn;
    ++path.scatterings;
    path.singular = false;
    path.density = v.next_density[lane];
    path.from = {vector_of(v.triangles.point, lane), vector_of(v.z, lane)};
    path.travelled = 0.0;
    path.kind = RayKind::Reflection;
    if (!survives_roulette(path)) return;
    go_on(path,
          {vector_of(v.origin, lane), vector_of(v.direction, lane), LeavingRays::kBeyondZero});
}

}  // namespace alhazen
