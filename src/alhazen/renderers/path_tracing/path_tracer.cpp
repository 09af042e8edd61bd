#include "alhazen/renderers/path_tracing/path_tracer.h"

#include <algorithm>
#include <optional>

#include "alhazen/illumination/emitter.h"
#include "alhazen/math/constants.h"
#include "alhazen/renderers/light_transport/volume_scattering.h"

namespace alhazen {

PathTracer::PathTracer(const RenderJob& job, std::size_t, RayCounters& counters,
                       const Illumination& lights, const PathSettings& settings,
                       LightLayers* layers, const ManifoldScene* manifold)
    : job_(job),
      scene_(job.scene),
      lights_(lights),
      chooses_light_(lights.chooses()),
      weights_(scene_),
      settings_(settings),
      counters_(counters),
      random_(job),
      camera_(job),
      visible_(scene_, job.count_tests ? &counters.tests : nullptr, true),
      shadows_(scene_, counters, job.count_tests ? &counters.tests : nullptr),
      bsdfs_(scene_, true),
      // Records, layers, polarisation and manifold search handle one vertex at a time.
      most_waiting_(job.path != nullptr || layers != nullptr || settings.polarization ||
                            manifold != nullptr
                        ? 1
                        : kMostWaiting),
      uses_lanes_(most_waiting_ > 1 && !random_.is_spectral()),
      escapes_later_(uses_lanes_ && lights.has_sky_picture()),
      has_environment_(lights.has_environment()),
      plain_(scene_),
      // LeavingRays at triangles: four times that bound at their largest coordinate, at most.
      most_beside_(lights.rounding() + 4.0 * rounding_within(scene_.aggregate->box())),
      draws_(lights),
      faces_(scene_),
      media_(scene_),
      layers_(layers),
      manifold_(manifold) {
    lanes_.shadow_rays_alone = weights_.shadow_rays_alone();
    if (media_.has_open_boundaries()) visible_.report_openings();
    if (manifold != nullptr) chains_.emplace(scene_, *manifold, counters, shadows_);
}

void PathTracer::trace_samples(std::span<const SampleId> ids, std::span<const Ray> rays,
                               std::span<Rgb> radiance) {
    ids_ = ids;
    // After an exception in a bounce they still refer to the paths of the last batch.
    waiting_ = in_lanes_ = 0;
    escaped_.clear();
    next_kinds_ = {};
    next_kinds_[static_cast<std::size_t>(RayKind::Eye)] = rays.size();
    draws_.clear();
    lanes_.triangles.clear();
    rough_.clear();
    random_.begin(ids);
    paths_.resize(rays.size());
    alive_.clear();
    rays_.resize(rays.size());
    next_rays_.resize(rays.size());
    if (random_.is_spectral()) waves_.assign(rays.size(), {});
    polarized_.clear();
    for (std::uint32_t i = 0; i < rays.size(); ++i) {
        EyePath& path = paths_[i] = EyePath();
        path.sample = i;
        alive_.push_back(i);
        path.time = camera_.time(random_, ids[i]);
        path.cone = job_.cone;
        rays_[i] = camera_.through_lens(random_, ids[i], rays[i], path.time);
        path.media = camera_.media(rays_[i], path.time);
        path.inside = !path.media.empty();
        if (settings_.polarization) {
            const Vec3 axis = picture_axis(rays_[i].direction, camera_.up(path.time));
            polarized_.emplace_back().begin(axis);
        }
    }
    light_.assign(rays.size(), {});
    begin_record();
    if (layers_ != nullptr) parts_.assign(rays.size(), {});
    for (bool first = true; !alive_.empty(); first = false) {
        if (job_.stop_requested()) return;
        bounce(first);
    }
    for (std::uint32_t i = 0; i < rays.size(); ++i) {
        // Black light needs no wavelengths.
        const Wavelengths& waves = light_[i].is_black() ? kColorChannels : waves_of(i);
        radiance[i] = waves.color(light_[i]);
        if (i == recorded_) job_.path->radiance = radiance[i];
        if (layers_ != nullptr) layers_->add(ids[i], parts_[i], waves, radiance[i]);
    }
}

void PathTracer::bounce(bool first) {
    next_alive_.clear();
    joined_.clear();
    joined_.reserve(joins_apart() ? alive_.size() : 0);
    joined_to_eye_.clear();
    for (std::size_t kind = 0; kind < kRayKindCount; ++kind) {
        counters_[static_cast<RayKind>(kind)].cast += next_kinds_[kind];
    }
    next_kinds_ = {};
    visible_.find(
        std::span<const Ray>(rays_).first(alive_.size()),
        first ? Coherence::Coherent : Coherence::Any,
        [&](std::size_t k) -> const EyePath& { return paths_[alive_[k]]; },
        [&](std::size_t k, const ShadingPoint* point, double t) {
            const std::uint32_t sample = alive_[k];
            EyePath& path = paths_[sample];
            Spectrum& sum = light_[sample];
            if (sample == recorded_) record_ray(path, rays_[k], point, t);
            if (point == nullptr) {
                const Medium* const medium = media_.any() ? path.media.here() : nullptr;
                const bool scatters = medium != nullptr && media_.in(*medium) != nullptr;
                if (scatters && cross_medium(path, *medium, rays_[k], kInfinity, sum)) return;
                if (!has_environment_) return;
                if (!escapes_later_) return escape(path, rays_[k], sum);
                escaped_.push_back(static_cast<std::uint32_t>(k));
                return;
            }
            ++counters_[path.kind].hit;
            meet(path, rays_[k], *point, t, sum);
        },
        [&](std::size_t k, const Hit& hit) {
            return takes_into_lane(paths_[alive_[k]], rays_[k], hit);
        });
    escape_all();
    scatter_lanes();
    scatter_all();
    shadows_.finish();
    if (recorded_ != kNoSample) record_arrival();
    if (joins_apart()) add_joined();
    alive_.swap(next_alive_);
    rays_.swap(next_rays_);
    random_.keep(alive_);
}

bool PathTracer::pass(EyePath& path, const ShadingPoint& point) {
    if (path.met >= kMaxPassedSurfaces) {
        record_step(path, PathStep::PassedMost);
        return false;
    }
    record_step(path, PathStep::Straight);
    if (media_.has_open_boundaries()) {
        passed_.set(scene_, point, path.media, waves(path), false, &bsdfs_);
        passed_.cross_opening(path.media);
        path.inside = !path.media.empty();
    }
    return true;
}

void PathTracer::meet(EyePath& path, const Ray& ray, const ShadingPoint& point, double t,
                      Spectrum& sum) {
    if (const Medium* medium = path.media.here(); medium != nullptr) {
        if (cross_medium(path, *medium, ray, t, sum)) return;
    }
    path.travelled += t;
    path.cone = path.cone.from(t);
    // `point` is that of `visible_`, which the other surfaces at its place are read into.
    std::optional<HitAlong> back;
    while (true) {
        const bool stops = random_.stops(ids_[path.sample], path.met++, point.material->coverage);
        if (stops && !is_hit_from_behind(point)) break;
        if (stops) {
            if (!back) back = {visible_.reported_hit(), visible_.reported_ray()};
        } else if (!pass(path, point)) {
            return;
        }
        if (visible_.next_here(path) == nullptr) {
            if (!back) return go_on(path, visible_.beyond(ray.direction));
            visible_.report(*back, path);
            break;
        }
        if (path.sample == recorded_ && !stops) record_ray(path, visible_.ray_here(), &point, 0.0);
    }
    const Hit& hit = back && is_hit_from_behind(point) ? back->hit : visible_.reported_hit();
    if (scene_.all_opaque) return stop(path, ray, hit, point, sum);
    const Arrival arrival{path.inside, path.cone.width, path.time, path.kind != RayKind::Eye};
    const std::optional<Hit> met = faces_.find(
        point, {ray.direction, arrival, mask_of(path.kind), path.media, waves(path), &bsdfs_},
        other_face_);
    if (!met) return stop(path, ray, hit, point, sum);
    stop(path, ray, *met, other_face_, sum);
}

void PathTracer::stop(EyePath& path, const Ray& ray, const Hit& hit, const ShadingPoint& point,
                      Spectrum& sum) {
    add_emission(path, ray, hit, point, sum);
    const bool deepest = path.scatterings >= settings_.depth;
    if (point.material->unlit || (deepest && !media_.may_be_passed(*point.material))) {
        if (!point.material->unlit) record_step(path, PathStep::Deepest);
        return;
    }
    Vertex& vertex = vertices_[waiting_];
    vertex.scatter.set(scene_, point, path.media, waves(path), false, &bsdfs_, &faces_.others(),
                       faces_.sheet());
    if (deepest && !vertex.scatter.may_be_passed()) {
        record_step(path, PathStep::Deepest);
        return;
    }
    if (vertex.scatter.needs_hero()) keep_hero(path);
    if (vertex.scatter.is_black()) return;
    vertex.path = &path;
    vertex.point = most_waiting_ == 1 ? &point : nullptr;
    vertex.place = point.surface.point;
    vertex.leaving.emplace(point.surface);
    if (++waiting_ == most_waiting_) scatter_all();
}

void PathTracer::scatter_all() {
    const std::span<const Vertex> vertices = std::span(vertices_).first(waiting_);
    for (const Vertex& vertex : vertices) {
        if (!is_lit(vertex)) continue;
        const EyePath& path = *vertex.path;
        const Vec2 place = random_.draw(path.sample, path.drawn, PathRandomness::kLight);
        const double choice = choices(path, chooses_light_).y;
        draws_.add({vertex.place, vertex.scatter.normal(), vertex.scatter.is_lit_from_both_sides()},
                   choice, place, waves(path));
    }
    draws_.draw();
    draw_directions(vertices);
    for (std::size_t i = 0, lit = 0; i < vertices.size(); ++i) {
        const Vertex& vertex = vertices[i];
        if (is_lit(vertex)) {
            Spectrum& sum = light_[vertex.path->sample];
            add_direct_light(vertex, draws_[lit++], sum);
            if (chains_) add_chains(vertex, sum);
        }
        scatter(vertex, directions_[i]);
    }
    draws_.clear();
    bsdfs_.release();
    waiting_ = 0;
}

void PathTracer::draw_directions(std::span<const Vertex> vertices) {
    std::array<Vec2, kMostWaiting> matt;
    std::array<std::size_t, kMostWaiting> places;
    std::size_t count = 0;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        const EyePath& path = *vertices[i].path;
        const ScatterPoint& scatter = vertices[i].scatter;
        const Vec2 u = random_.draw(path.sample, path.drawn, PathRandomness::kDirection);
        if (scatter.is_matt()) {
            places[count] = i;
            matt[count++] = u;
        } else {
            const bool has_lobes = scatter.has_density() || scatter.has_singular();
            const double choice = choices(path, has_lobes && scatter.chooses()).x;
            directions_[i] = scatter.sample(choice, u, Transport::Radiance);
        }
    }
    std::array<Vec3, kMostWaiting> found;
    set_matt_directions(std::span(matt).first(count), found.data());
    for (std::size_t k = 0; k < count; ++k) {
        directions_[places[k]] = vertices[places[k]].scatter.sample_matt(found[k]);
    }
}

bool PathTracer::cross_medium(EyePath& path, const Medium& medium, const Ray& ray, double t,
                              Spectrum& sum) {
    const Spectrum absorption = waves(path).absorption(medium.absorption);
    const VolumeScattering* const scattering = media_.in(medium);
    if (scattering == nullptr) {
        path.throughput = path.throughput * transmittance(absorption, t);
        return false;
    }
    const VolumeStep step =
        step_in_volume(absorption, waves(path).absorption(scattering->coefficient), path.throughput,
                       t, random_.in_volume(ids_[path.sample], path.stretch++));
    path.throughput = path.throughput * step.weight;
    if (!step.scatters) return false;
    path.cone = path.cone.from(step.distance);
    if (RecordedVertex* vertex = recorded(path)) {
        vertex->t = step.distance;
        vertex->in_volume = true;
        vertex->step = PathStep::Deepest;
    }
    if (path.scatterings < settings_.depth && path.throughput.max() > 0.0) {
        scatter_in_volume(path, medium, {ray.at(step.distance), ray.direction}, sum);
    }
    return true;
}

/// `ray`: from the point of scattering, straight on.
void PathTracer::scatter_in_volume(EyePath& path, const Medium& medium, const Ray& ray,
                                   Spectrum& sum) {
    const double g = media_.in(medium)->anisotropy;
    const LitPoint at = LitPoint::inside_volume(ray.origin);
    if (path.scatterings == 0) path.first = {.transmitted = true};
    const Vec2 place = random_.draw(path.sample, path.drawn, PathRandomness::kLight);
    const double choice = choices(path, chooses_light_).y;
    const LightDraw drawn = lights_.draw(at, choice, place, waves(path));
    if (drawn.density > 0.0 && !drawn.radiance.is_black()) {
        const double phase = henyey_greenstein(dot(ray.direction, drawn.to_light), g);
        double weight = phase / drawn.density;
        if (!drawn.singular) weight *= weights_.of_shadow_ray(drawn.density, phase);
        const Ray to_light = ray_to_light(lights_, ray.origin, {ray.origin, drawn.to_light},
                                          drawn.distance, drawn.place, drawn.facing);
        const Spectrum shown =
            limited_joined(path.throughput * (weight * drawn.radiance), path.scatterings + 1);
        Spectrum* const waiting = record_shadow(path, to_light, shown);
        Spectrum& to =
            waiting != nullptr ? *waiting : place_of_joined(path, path.first, nullptr, {}, sum);
        shadows_.add(to_light, path.time, path.media, waves(path), shown, to);
    }
    const Vec2 u = random_.draw(path.sample, path.drawn, PathRandomness::kDirection);
    const Vec3 direction = sample_henyey_greenstein(ray.direction, g, u);
    if (settings_.polarization) polarized_[path.sample].depolarize();
    ++path.drawn;
    ++path.scatterings;
    path.singular = false;
    path.trail = {};
    path.density = henyey_greenstein(dot(ray.direction, direction), g);
    path.from = at;
    path.travelled = 0.0;
    path.kind = RayKind::Refraction;
    record_step(path, PathStep::Scattered);
    if (survives_roulette(path)) go_on(path, {ray.origin, direction});
}

void PathTracer::scatter(const Vertex& vertex, const std::optional<Scattered>& drawn) {
    EyePath& path = *vertex.path;
    const ScatterPoint& scatter = vertex.scatter;
    if (!drawn || drawn->weight.is_black()) return;
    if (!drawn->straight && path.scatterings >= settings_.depth) {
        record_step(path, PathStep::Deepest);
        return;
    }
    path.throughput = path.throughput * drawn->weight;
    if (drawn->dispersed) keep_hero(path);
    if (layers_ != nullptr && path.scatterings == 0 && !drawn->straight) {
        path.first = first_along(vertex, drawn->direction);
        if (drawn->singular) path.first.diffuse = {};
    }
    ++path.drawn;
    record_step(path, drawn->straight   ? PathStep::Straight
                      : drawn->singular ? PathStep::Mirrored
                                        : PathStep::Scattered);
    if (drawn->straight) {
        // Shadow rays pass thin sheets, too: density and point of the last scattering are kept.
        if (++path.met > kMaxPassedSurfaces) {
            record_step(path, PathStep::PassedMost);
            return;
        }
    } else {
        ++path.scatterings;
        if (settings_.polarization) {
            polarized_[path.sample].scatter(
                scatter.view(), drawn->direction,
                scatter.polarization(drawn->direction, drawn->singular));
        }
        if (manifold_ != nullptr) {
            if (drawn->singular) {
                path.trail.go_on(vertex.point->surface, drawn->transmitted);
            } else {
                path.trail.begin(drawn->density);
            }
        }
        path.singular = drawn->singular;
        path.density = drawn->density;
        path.from = {vertex.place, scatter.normal(), scatter.is_lit_from_both_sides()};
        path.travelled = 0.0;
        path.eta_scale *= drawn->transmitted ? drawn->eta * drawn->eta : 1.0;
        path.kind = drawn->transmitted ? RayKind::Refraction : RayKind::Reflection;
    }
    if (drawn->transmitted) {
        scatter.cross(path.media);
        path.inside = !path.media.empty();
    }
    if (!survives_roulette(path)) return;
    go_on(path, vertex.leaving->along(drawn->direction));
}

bool PathTracer::survives_roulette(EyePath& path) {
    if (!path.throughput.is_finite()) return false;
    if (path.scatterings <= settings_.roulette) return true;
    constexpr double kMost = 0.95;
    const double share = std::min(kMost, path.eta_scale * path.throughput.max());
    const double draw = random_.draw_first(path.sample, path.drawn - 1, PathRandomness::kRoulette);
    if (!(draw < share)) {
        record_step(path, PathStep::Roulette);
        return false;
    }
    path.throughput = (1.0 / share) * path.throughput;
    return true;
}

}  // namespace alhazen
