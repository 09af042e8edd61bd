#include "alhazen/renderers/light_transport/random_walk.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "alhazen/renderers/light_transport/emission_of.h"

namespace alhazen {

namespace {

constexpr double kEndless = std::numeric_limits<double>::infinity();

/// Number of an event, distinct for the two walks of a sample.
std::uint32_t of_walk(const WalkRandomness& draws, std::uint32_t event) {
    return draws.first_pair << 16 | event;
}

}  // namespace

bool RandomWalk::scatters_within(Front& front, const Medium& medium,
                                 const VolumeScattering& scattering, double length,
                                 const WalkRandomness& draws, const WalkStart& start) {
    const VolumeStep step = step_in_volume(
        front.waves.absorption(medium.absorption), front.waves.absorption(scattering.coefficient),
        front.throughput, length, draws.random.in_volume(draws.id, of_walk(draws, stretch_++)));
    front.throughput = front.throughput * step.weight;
    flight_.add(scattering_.extinction(&medium).of(*start.waves), step.distance);
    if (!step.scatters) return false;
    travelled_ += step.distance;
    front.ray = {front.ray.at(step.distance), front.ray.direction};
    return true;
}

void RandomWalk::absorb(Front& front, double length) const {
    // Scattering media are handled in `scatters_within`.
    if (const Medium* const medium = front.media.here();
        medium != nullptr && scattering_.in(*medium) == nullptr) {
        front.throughput =
            front.throughput * transmittance(front.waves.absorption(medium->absorption), length);
    }
}

void RandomWalk::pass_opening(Front& front) {
    opening_.set(scene_, point_, front.media, front.waves, false, &bsdfs_);
    if (!opening_.bounds_volume()) return;
    absorb(front, segment_);
    segment_ = 0.0;
    opening_.cross(front.media);
}

RandomWalk::Meets RandomWalk::find(Front& front, const WalkRandomness& draws,
                                   const WalkStart& start) {
    segment_ = 0.0;
    Ray& ray = front.ray;
    for (int passed = 0; passed <= kMaxPassedSurfaces; ++passed) {
        const Medium* const medium = front.media.here();
        const VolumeScattering* const scattering =
            medium != nullptr ? scattering_.in(*medium) : nullptr;
        ++counters_[kind_].cast;
        hit_ = Hit();
        passed_ = false;
        bool found = scene_.aggregate->closest(ray, hit_, {stats_, mask(), start.time});
        if (chooses_) {
            const double u = draws.random.extra(draws.id, of_walk(draws, chosen_++), 0);
            const PassedSurfaces::Choice choice = surfaces_.choose(ray, start.time, u, found, hit_);
            found = found || choice.passed;
            passed_ = choice.passed;
            front.throughput = choice.weight * front.throughput;
        }
        if (scattering != nullptr &&
            scatters_within(front, *medium, *scattering, found ? hit_.t : kEndless, draws, start)) {
            return passed_ ? Meets::Nothing : Meets::Volume;
        }
        if (!found) return Meets::Nothing;
        ++counters_[kind_].hit;
        const Arrival arrival{!front.media.empty(), 0.0, start.time, kind_ != RayKind::Eye};
        set_shading_point(scene_, ray, hit_, arrival, {.constant = &constant_}, point_);
        travelled_ += hit_.t;
        segment_ += hit_.t;
        if (stops_here(front, arrival, draws)) {
            const auto met = faces_.find(
                point_,
                {ray.direction, arrival, mask(), front.media, front.waves, &bsdfs_, &constant_},
                point_);
            if (met) hit_ = *met;
            return Meets::Surface;
        }
        if (passed_) return Meets::Nothing;
        ray = beyond_;
    }
    return Meets::Nothing;
}

bool RandomWalk::stops_here(Front& front, const Arrival& arrival, const WalkRandomness& draws) {
    std::optional<HitAlong> back;
    for (const Hit* other = &hit_; other != nullptr; other = here_.next()) {
        const bool is_first = other == &hit_;
        if (!is_first) {
            hit_ = *other;
            const Arrival onward{!front.media.empty(), 0.0, arrival.time, arrival.meets_backs};
            set_shading_point(scene_, here_.ray(), hit_, onward, {.constant = &constant_}, point_);
        }
        const bool stops =
            draws.random.stops(draws.id, of_walk(draws, met_++), point_.material->coverage);
        if (stops && (passed_ || !is_hit_from_behind(point_))) return true;
        if (passed_) return false;
        if (is_first) {
            here_.find(point_.surface, hit_, front.ray, {stats_, mask(), arrival.time});
            beyond_ = leaving_ray(point_.surface, front.ray.direction);
        }
        if (stops) {
            if (!back && !here_.any_left()) return true;
            if (!back) back = {hit_, is_first ? front.ray : here_.ray()};
        } else if (scattering_.has_open_boundaries()) {
            pass_opening(front);
        }
    }
    if (!back) return false;
    hit_ = back->hit;
    set_shading_point(scene_, back->ray, hit_, arrival, {.constant = &constant_}, point_);
    return true;
}

void RandomWalk::set_vertex(const Front& front, const WalkStart& start, Meets meets,
                            const Ends& ends) {
    PathVertex& v = ends.v;
    double cosine = 1.0;
    if (meets == Meets::Surface) {
        v.surface.value = point_.surface;
        v.coverage = point_.material->coverage;
        if (chooses_) v.seen_by = surfaces_.seen_by(hit_);
        cosine = std::abs(dot(front.ray.direction, point_.geometric));
    } else {
        const Medium& medium = *front.media.here();
        v.surface.value.point = front.ray.origin;
        v.volume = InsideVolume{front.ray.direction, scattering_.in(medium)->anisotropy,
                                scattering_.extinction(&medium).of(*start.waves)};
        v.in_volume = true;
    }
    v.throughput = front.throughput;
    v.media = front.media;
    v.distance = travelled_;
    v.density = front.parallel ? front.density * cosine
                               : front.density * cosine / (travelled_ * travelled_);
    if (flight_.scatters()) {
        v.forward = v.reached(flight_);
        v.density *= v.forward;
        v.backward = ends.before != nullptr ? ends.before->reached(flight_) : flight_.passing();
    }
}

void RandomWalk::set_emission(const Front& front, const Ends& ends) const {
    PathVertex& v = ends.v;
    const bool lights_others = ends.before != nullptr && !ends.before->singular;
    if (!point_.material->unlit || !lights_others) {
        v.emission = emission_of(scene_, point_, front.waves);
    }
    if (v.emission.is_black()) return;
    v.emit = lights_.emit_density(hit_, point_.surface, -front.ray.direction);
    if (ends.before == nullptr) return;
    const double cosine = std::abs(dot(front.ray.direction, point_.geometric));
    v.joined = cosine / (travelled_ * travelled_) *
               lights_.density(ends.before->lit(), front.ray, hit_, point_.surface, travelled_);
}

RandomWalk::Step RandomWalk::scatter_at_surface(Transport transport, Front& front,
                                                const WalkRandomness& draws, std::uint32_t pair,
                                                const Ends& ends) {
    PathVertex& v = ends.v;
    const bool from_eye = transport == Transport::Radiance;
    if (from_eye) set_emission(front, ends);
    v.scatter.set(scene_, point_, front.media, front.waves, true, &bsdfs_, &faces_.others(),
                  faces_.sheet());
    if (v.scatter.needs_hero()) {
        front.waves.keep_hero(front.throughput);
        v.throughput = front.throughput;
    }
    v.hero_only = front.waves.hero_only();
    if (point_.material->unlit) return Step::Ends;
    const double straight = v.scatter.straight_probability();
    if (ends.last && !v.scatter.may_be_passed()) return Step::Ends;
    const Vec2 u = draws.random.draw(draws.id, pair);
    const Vec2 choices = draws.random.draw(draws.id, pair + 1);
    const std::optional<Scattered> drawn = v.scatter.sample(choices.x, u, transport);
    if (straight > 0.0) {
        // A thin sheet that is passed straight, by chance, is no vertex. One that shines is one for
        // half of the paths at least, some of which end there, or few would show its light.
        const double scattered = 1.0 - straight;
        const double stays = v.emission.is_black() ? scattered : std::max(scattered, 0.5);
        const double ended = (stays - scattered) / straight;
        const bool ends_here = choices.y < ended;
        if (stays > 0.0 && (ends_here || !(drawn && drawn->straight))) {
            v.throughput = (1.0 / stays) * v.throughput;
        }
        if (ends_here) return Step::Ends;
        front.throughput = (1.0 / (1.0 - ended)) * front.throughput;
    }
    if (!drawn || drawn->weight.is_black() || (ends.last && !drawn->straight)) return Step::Ends;
    front.throughput = front.throughput * drawn->weight;
    if (drawn->dispersed) front.waves.keep_hero(front.throughput);
    if (!from_eye) {
        front.throughput = v.scatter.importance_correction(drawn->direction) * front.throughput;
    }
    if (drawn->transmitted) v.scatter.cross(front.media);
    front.ray.direction = drawn->direction;
    // What an eye ray passes straight leaves it an eye ray.
    if (!(drawn->straight && from_eye)) {
        kind_ = drawn->transmitted ? RayKind::Refraction : RayKind::Reflection;
    }
    if (drawn->straight) return Step::Straight;
    if (!continues(drawn->singular) || (v.seen_by & mask_of(kind_)) == 0) return Step::Ends;
    eta_scale_ *= drawn->transmitted && from_eye ? drawn->eta * drawn->eta : 1.0;
    v.singular = drawn->singular;
    front.density = drawn->singular ? 1.0 : drawn->density;
    if (drawn->singular) {
        v.back = drawn->mutual ? 1.0 : 0.0;
    } else {
        v.back = v.scatter.reverse_density(drawn->direction);
    }
    return Step::Scattered;
}

RandomWalk::Step RandomWalk::scatter_in_volume(Front& front, const WalkRandomness& draws,
                                               std::uint32_t pair, const Ends& ends) {
    PathVertex& v = ends.v;
    v.hero_only = front.waves.hero_only();
    if (ends.last || !continues(false) || !(front.throughput.max() > 0.0)) return Step::Ends;
    const InsideVolume& volume = v.volume.value;
    const Vec3 direction = sample_henyey_greenstein(volume.along, volume.anisotropy,
                                                    draws.random.draw(draws.id, pair));
    kind_ = RayKind::Refraction;
    front.ray.direction = direction;
    front.density = v.back = v.density_along(direction);
    return Step::Scattered;
}

void RandomWalk::choose_first(Front& front, const WalkRandomness& draws) {
    connects_ = draws.random.extra(draws.id, of_walk(draws, chosen_++), 0) < 0.5;
    first_ = connects_ ? FirstSegment::Connected : FirstSegment::Hit;
    front.throughput = 2.0 * front.throughput;
}

void RandomWalk::walk(Transport transport, const WalkStart& start, const WalkRandomness& draws,
                      std::vector<PathVertex>& vertices) {
    vertices.clear();
    escape_ = {};
    met_ = stretch_ = 0;
    travelled_ = 0.0;
    flight_.begin();
    eta_scale_ = 1.0;
    const bool from_eye = transport == Transport::Radiance;
    kind_ = from_eye ? RayKind::Eye : RayKind::Reflection;
    connects_ = start.as_connection;
    first_ = FirstSegment::Any;
    chooses_ = !from_eye && surfaces_.exist();
    chosen_ = 0;
    Front front{start.ray,     *start.waves,   start.throughput,
                start.density, start.parallel, start.media};
    if (start.of_either) choose_first(front, draws);
    passed_ = false;
    front.media.keep_seen_by(mask());
    int count = 0;
    for (std::uint32_t pair = draws.first_pair; count < draws.most; pair += kWalkPairs) {
        const Meets meets = find(front, draws, start);
        absorb(front, meets == Meets::Nothing ? kEndless : segment_);
        if (meets == Meets::Nothing) {
            escape_ = {true, front.ray.direction, front.throughput,
                       front.density * flight_.passing(),
                       count == 0 ? 1.0 : vertices.back().reached(flight_)};
            return;
        }
        PathVertex& v = vertices.emplace_back();
        const Ends ends{v, count > 0 ? &v - 1 : nullptr, ++count == draws.most};
        set_vertex(front, start, meets, ends);
        const Step step = meets == Meets::Volume
                              ? scatter_in_volume(front, draws, pair, ends)
                              : scatter_at_surface(transport, front, draws, pair, ends);
        if (step == Step::Ends) {
            if (first_ == FirstSegment::Hit || (v.seen_by & kRaysOfPaths) == 0) {
                vertices.pop_back();
            }
            return;
        }
        if (step == Step::Straight) {
            vertices.pop_back();
            --count;
            if (passed_ || ++met_ > kMaxPassedSurfaces) return;
            front.ray = leaving_ray(point_.surface, front.ray.direction);
            continue;
        }
        if (first_ == FirstSegment::Hit) v.seen_by = 0;
        front.parallel = false;
        if (ends.before != nullptr) {
            ends.before->reverse =
                v.back * ends.before->facing(v.view()) / (v.distance * v.distance) * v.backward;
        }
        if (!front.throughput.is_finite()) return;
        if (count >= draws.roulette) {
            constexpr double kMost = 0.95;
            // Light paths have power of any scale: relative to that at the start.
            const double begun = from_eye ? 1.0 : start.throughput.max();
            const double share = std::min(kMost, eta_scale_ * front.throughput.max() / begun);
            if (!(draws.random.draw(draws.id, pair + 2).x < share)) return;
            front.throughput = (1.0 / share) * front.throughput;
        }
        front.ray = v.leaving(front.ray.direction, kEndless);
        connects_ = false;
        first_ = FirstSegment::Any;
        travelled_ = 0.0;
        flight_.begin();
    }
}

}  // namespace alhazen
