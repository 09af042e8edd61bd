#include "alhazen/renderers/bidirectional/bidirectional_tracer.h"

#include <cmath>

#include "alhazen/renderers/light_transport/lens_ray.h"

namespace alhazen {

namespace {

/// Pairs of dimensions in addition to those of the eye's walk: of the light, of its walk, of the
/// lens position for each of its vertices, of the lights sampled for the eye's vertices.
constexpr std::uint32_t kLightPairs = 1u << 12, kLightWalk = 2u << 12, kLensPairs = 3u << 12,
                        kDrawPairs = 4u << 12;

/// Converts a density by solid angle, of a direction that arrives at a vertex, to the vertex'
/// measure.
double at_vertex(double density, const Vec3& direction, const PathVertex& v, double distance) {
    return density * v.facing(direction) / (distance * distance);
}

/// Density of the vertex before `v` on a path that would continue from `v` to it, by `back`.
double at_vertex_before(double back, const PathVertex& v, const PathVertex& before) {
    return at_vertex(back, v.view(), before, v.distance) * v.backward;
}

}  // namespace

BidirectionalTracer::BidirectionalTracer(const RenderJob& job, std::size_t, RayCounters& counters,
                                         const Illumination& lights, const PathSettings& settings,
                                         LensLight* lens_light)
    : job_(job),
      scene_(job.scene),
      lights_(lights),
      weights_(scene_),
      settings_(settings),
      counters_(counters),
      stats_(job.count_tests ? &counters.tests : nullptr),
      random_(job),
      camera_(job),
      lens_(job),
      starts_(job.scene),
      walk_(job.scene, lights, counters, stats_),
      joins_(job.scene, counters, stats_),
      lens_light_(*lens_light) {}

void BidirectionalTracer::trace_samples(std::span<const SampleId> ids, std::span<const Ray> rays,
                                        std::span<Rgb> radiance) {
    random_.begin(ids);
    for (std::uint32_t i = 0; i < rays.size(); ++i) {
        if (job_.stop_requested()) return;
        waves_ = all_waves_ != nullptr ? *all_waves_ : random_.waves(i);
        const Spectrum light = trace(ids[i], rays[i]);
        radiance[i] = waves_.color(light);
    }
    lens_light_.paths.fetch_add(rays.size(), std::memory_order_relaxed);
}

Spectrum BidirectionalTracer::trace(const SampleId& id, const Ray& central) {
    Spectrum sum;
    const float time = camera_.time(random_, id);
    const Ray ray = camera_.through_lens(random_, id, central, time);
    WalkStart start{.ray = ray, .time = time, .media = camera_.media(ray, time)};
    start.waves = &waves_;
    start.parallel = lens_.is_parallel();
    start.density =
        start.parallel ? lens_.parallel_density() : lens_.direction_density(ray.direction, time);
    // One vertex more than scatterings: the last may be on a light.
    walk_.walk(Transport::Radiance, start,
               {random_, id, PathRandomness::kFirstBounce, settings_.depth + 1, settings_.roulette},
               eye_);
    escape_ = walk_.escape();

    light_.clear();
    const LightRay light =
        lights_.emit(random_.draw(id, kLightPairs).x, random_.draw(id, kLightPairs + 1),
                     random_.draw(id, kLightPairs + 2), waves_);
    const WalkStart from_light = starts_.of(light, time, waves_);
    if (!from_light.throughput.is_black() && from_light.throughput.is_finite()) {
        begin_.place = lights_.point_of_light(light.place, light.ray.origin);
        begin_.emit = {light.place_density, light.direction_density};
        walk_.walk(Transport::Importance, from_light,
                   {random_, id, kLightWalk, settings_.depth, settings_.roulette}, light_);
        set_falloff(lights_, light, waves_, light_);
    }

    for (std::size_t b = 1; b <= eye_.size(); ++b) {
        hit_light(b, sum);
        if (static_cast<int>(b) <= settings_.depth) join_light(id, b, time, sum);
    }
    hit_environment(sum);
    merge(sum);
    for (std::size_t a = 1; a <= light_.size(); ++a) {
        join_lens(id, a, time);
        for (std::size_t b = 1; b <= eye_.size(); ++b) {
            if (static_cast<int>(a + b) <= settings_.depth) join(a, b, time, sum);
        }
    }
    return sum;
}

void BidirectionalTracer::begin_path(std::size_t a, std::size_t b) {
    path_.vertices.assign(1 + a + b, {});
    path_.joined = 0.0;
    path_.emitted = path_.hit = true;
    for (std::size_t i = 0; i < a; ++i) {
        const PathVertex& v = light_[i];
        const bool is_last = i + 1 == a;
        of_light(i) = {v.density, i + 2 < a ? v.reverse : 0.0, !is_last && v.singular, v.in_volume};
    }
    for (std::size_t i = 0; i < b; ++i) {
        const PathVertex& v = eye_[i];
        const bool is_last = i + 1 == b;
        of_eye(i) = {i + 2 < b ? v.reverse : 0.0, v.density, !is_last && v.singular, v.in_volume};
    }
}

void BidirectionalTracer::set_light(const LightEnd& end, const LitVertex& lit) {
    WholePath::Vertex& zero = path_.vertices[0];
    const Illumination::LightPoint& place = end.place;
    const double drawn = lights_.density(lit.v.lit(), place, lit.to_light, lit.distance);
    path_.hit = place.is_hit;
    path_.emitted = end.emit.place > 0.0 && end.emit.direction > 0.0;
    const bool has_area = place.normal != Vec3{};
    double sent = 0.0;
    if (place.infinite) {
        zero.from_light = end.emit.direction;
        sent = end.emit.place * lit.v.facing(lit.to_light);
    } else {
        zero.from_light = end.emit.place;
        sent = at_vertex(end.emit.direction, lit.to_light, lit.v, lit.distance);
    }
    path_.vertices[1].from_light = sent * lit.reached;
    const auto there = [&](double density) {
        return has_area ? density * std::abs(dot(lit.to_light, place.normal)) /
                              (lit.distance * lit.distance)
                        : density;
    };
    zero.from_eye = there(lit.eye_density) * lit.backward;
    path_.joined = there(drawn);
    if (is_only_joined()) path_.hit = false;
}

void BidirectionalTracer::set_light_of_path(double eye_density) {
    const PathVertex& first = light_[0];
    set_light(begin_,
              {first, first.view(), first.distance, eye_density, first.forward, first.backward});
}

void BidirectionalTracer::hit_light(std::size_t b, Spectrum& sum) {
    const PathVertex& last = eye_[b - 1];
    if (last.emission.is_black()) return;
    const Spectrum light = last.throughput * last.emission;
    if (b == 1) {
        sum += light;
        return;
    }
    // Vertex 0 is the last eye vertex; the path has b - 1 others.
    const PathVertex& lit_vertex = eye_[b - 2];
    begin_path(0, b - 1);
    path_.vertices[1].singular = lit_vertex.singular;
    path_.vertices[0] = {last.emit.place, last.density, false};
    path_.emitted = last.emit.place > 0.0 && last.emit.direction > 0.0;
    of_eye(b - 2).from_light = at_vertex_before(last.emit.direction, last, lit_vertex);
    if (b >= 3) of_eye(b - 3).from_light = eye_[b - 3].reverse;
    path_.joined = last.joined;
    if (is_only_joined()) return;
    sum += path_weight(path_, 0) * light;
}

void BidirectionalTracer::hit_environment(Spectrum& sum) {
    if (!escape_.is) return;
    const Spectrum light = escape_.throughput * lights_.environment(escape_.direction, waves_);
    if (light.is_black()) return;
    const std::size_t b = eye_.size();
    if (b == 0) {
        sum += light;
        return;
    }
    const PathVertex& last = eye_[b - 1];
    begin_path(0, b);
    path_.vertices[1].singular = last.singular;
    const Illumination::EmitDensity emit =
        lights_.environment_emit_density(-escape_.direction, last.point());
    path_.vertices[0] = {emit.direction, escape_.density, false};
    path_.emitted = emit.place > 0.0 && emit.direction > 0.0;
    of_eye(b - 1).from_light = emit.place * last.facing(escape_.direction) * escape_.backward;
    if (b >= 2) of_eye(b - 2).from_light = eye_[b - 2].reverse;
    path_.joined = lights_.environment_density(last.lit(), escape_.direction);
    if (is_only_joined()) return;
    sum += path_weight(path_, 0) * light;
}

void BidirectionalTracer::join_light(const SampleId& id, std::size_t b, float time, Spectrum& sum) {
    const PathVertex& v = eye_[b - 1];
    if (!v.connects()) return;
    const auto pair = kDrawPairs + 2 * static_cast<std::uint32_t>(b);
    const LightDraw drawn =
        lights_.draw(v.lit(), random_.draw(id, pair).x, random_.draw(id, pair + 1), waves_);
    if (!(drawn.density > 0.0) || drawn.radiance.is_black()) return;
    Spectrum light = v.value(drawn.to_light, Transport::Radiance) * drawn.radiance;
    if (light.is_black()) return;
    FreeFlight flight;
    const Spectrum passing =
        joins_.passing(ray_to_light(lights_, v.point(), v.leaving(drawn.to_light, drawn.distance),
                                    drawn.distance, drawn.place, drawn.facing),
                       time, v.media_along(drawn.to_light, behind_), waves_, &flight);
    if (passing.is_black()) return;
    LightEnd end;
    const double away = std::isfinite(drawn.distance) ? drawn.distance : 0.0;
    end.place = lights_.point_of_light(drawn.place, v.point() + away * drawn.to_light);
    end.emit = lights_.emit_density(end.place, -drawn.to_light, v.point());
    begin_path(0, b);
    set_light(end, {v, drawn.to_light, drawn.distance, v.density_along(drawn.to_light),
                    v.reached(flight), flight.passing()});
    if (b >= 2) {
        of_eye(b - 2).from_light = at_vertex_before(v.density_back(drawn.to_light), v, eye_[b - 2]);
    }
    light = (path_weight(path_, 1) / drawn.density) * (v.throughput * light);
    sum += passing * light;
}

void BidirectionalTracer::join(std::size_t a, std::size_t b, float time, Spectrum& sum) {
    const PathVertex &y = light_[a - 1], &z = eye_[b - 1];
    if (!y.connects() || !z.connects()) return;
    const Vec3 offset = y.point() - z.point();
    const double squared = length_squared(offset), distance = std::sqrt(squared);
    if (!(distance > 0.0)) return;
    const Vec3 to_y = offset / distance, to_z = -to_y;
    const Spectrum at_z = z.value(to_y, Transport::Radiance);
    if (at_z.is_black()) return;
    const Spectrum at_y = y.value(to_z, Transport::Importance);
    if (at_y.is_black()) return;
    Spectrum light =
        (y.importance_correction(to_z) / squared) * (y.throughput * at_y * z.throughput * at_z);
    if (light.is_black()) return;
    const RayKind kind = z.kind_along(to_y);
    if ((y.seen_by & mask_of(kind)) == 0) return;
    FreeFlight flight;
    const Ray ray = ray_between(z.point(), z.leaving(to_y, distance), y.point(),
                                y.leaving(to_z, distance), distance, y.facing(to_z));
    const Spectrum passing =
        joins_.between(ray, time, kind, z.media_along(to_y, behind_), waves_, &flight);
    if (passing.is_black()) return;
    begin_path(a, b);
    of_light(a - 1).from_eye =
        at_vertex(z.density_along(to_y), to_y, y, distance) * y.reached(flight);
    of_eye(b - 1).from_light =
        at_vertex(y.density_along(to_z), to_z, z, distance) * z.reached(flight);
    const double back = y.density_back(to_z);
    if (a >= 2) of_light(a - 2).from_eye = at_vertex_before(back, y, light_[a - 2]);
    if (b >= 2) of_eye(b - 2).from_light = at_vertex_before(z.density_back(to_y), z, eye_[b - 2]);
    set_light_of_path(a == 1 ? back : light_[0].back);
    light = path_weight(path_, static_cast<int>(a) + 1) * light;
    // If both sides have only the hero, its factor of four must count once.
    if (y.hero_only && z.hero_only) light = (1.0 / Spectrum::kCount) * light;
    sum += passing * light;
}

void BidirectionalTracer::join_lens(const SampleId& id, std::size_t a, float time) {
    const PathVertex& y = light_[a - 1];
    if (!y.connects()) return;
    const auto joined = lens_.connect(
        y.point(), random_.draw(id, kLensPairs + static_cast<std::uint32_t>(a)), time);
    if (!joined || !y.is_seen_from(joined->to_lens)) return;
    const Spectrum value = y.value(joined->to_lens, Transport::Importance);
    if (value.is_black()) return;
    FreeFlight flight;
    const Ray ray = from_lens(y, *joined);
    const Spectrum seen =
        joins_.seen(ray, time, media_from_lens(camera_, ray, time, y, behind_), waves_, &flight);
    if (seen.is_black()) return;
    begin_path(a, 0);
    of_light(a - 1).from_eye = joined->density * y.facing(joined->to_lens) * y.reached(flight);
    const double back = y.density_back(joined->to_lens);
    if (a >= 2) of_light(a - 2).from_eye = at_vertex_before(back, y, light_[a - 2]);
    set_light_of_path(a == 1 ? back : light_[0].back);
    Spectrum light = path_weight(path_, static_cast<int>(a) + 1) * joined->density *
                     y.importance_correction(joined->to_lens) * (y.throughput * value);
    light = light * seen;
    if (!light.is_black() && !lens_light_.splats.add(joined->film, waves_.color(light))) {
        ++counters_.non_finite;
    }
}

}  // namespace alhazen
