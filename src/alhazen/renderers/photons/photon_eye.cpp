#include "alhazen/renderers/photons/photon_eye.h"

#include <algorithm>

#include "alhazen/renderers/light_transport/emission_of.h"
#include "alhazen/renderers/light_transport/volume_scattering.h"
#include "alhazen/renderers/photons/photon_density.h"
#include "alhazen/sampling/even_numbers.h"
#include "alhazen/sampling/random.h"

namespace alhazen {

namespace {

constexpr int kMostSplits = 1000;  ///< limit per sample

/// Keys of hashes.
constexpr std::uint64_t kLooks = 0x6c6f6f6b, kWays = 0x77617973, kTurn = 0x7475726e,
                        kShift = 0x73686966;
/// Keys of the branches at smooth glass.
constexpr std::uint64_t kDimWay = 1, kBrightWay = 2;

/// True if a choice among singular directions is certain.
bool is_certain(double probability) {
    return probability > 1.0 - 0x1p-40;
}

/// True for one of each `samples` successive samples, chosen at random by `key` within each run. A
/// fixed stride would always select the same part of the pixel and of the shutter, since samplers
/// traverse both in the order of the bits of the index.
bool is_turn(std::uint64_t key, std::uint64_t number, std::uint64_t samples) {
    return number % samples == mix64(key ^ mix64(number / samples)) % samples;
}

/// Sum of two numbers below 1, modulo 1.
double shifted(double sum) {
    return sum < 1.0 ? sum : sum - 1.0;
}

}  // namespace

PhotonEye::PhotonEye(const RenderJob& job, RayCounters& counters, const Illumination& lights,
                     const PathSettings& settings, std::span<const Wavelengths> waves)
    : job_(job),
      scene_(job.scene),
      counters_(counters),
      settings_(settings),
      shadows_(scene_, counters, job.count_tests ? &counters.tests : nullptr),
      lights_(lights),
      weights_(scene_),
      random_(job),
      camera_(job),
      next_(scene_, counters, job.count_tests ? &counters.tests : nullptr),
      given_(waves.begin(), waves.end()) {}

void PhotonEye::trace_samples(std::span<const SampleId> ids, std::span<const Ray> rays,
                              std::span<Rgb> radiance) {
    // Shadow rays are traced in batches; their light is added last, for sums independent of the
    // batch.
    light_.assign(rays.size(), {});
    direct_.assign(rays.size(), {});
    waves_.clear();
    for (const SampleId& id : ids) waves_.push_back(given_[id.number % given_.size()]);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        if (job_.stop_requested()) return;
        trace(ids[i], rays[i], waves_[i], light_[i], direct_[i]);
    }
    shadows_.finish();
    for (std::size_t i = 0; i < rays.size(); ++i) {
        radiance[i] = waves_[i].color(light_[i] + direct_[i]);
    }
}

void PhotonEye::trace(const SampleId& id, const Ray& ray, const Wavelengths& waves, Spectrum& sum,
                      Spectrum& direct) {
    Branch first;
    PathEnd& path = first.path;
    first.waves = waves;
    path.time = camera_.time(random_, id);
    path.cone = job_.cone;
    path.ray = camera_.through_lens(random_, id, ray, path.time);
    path.media = camera_.media(path.ray, path.time);
    first.way = mix64(job_.round->seed ^ mix64(id.pixel.id() ^ kWays));
    waiting_.assign(1, first);
    splits_ = 0;
    for (int event = 0; !waiting_.empty();) {
        Branch at = waiting_.back();
        waiting_.pop_back();
        // Stratified numbers are uniform over successive samples only.
        if (at.stride > 1) event = std::max(event, PathRandomness::kStratified);
        follow(id, at, event, waves, sum, direct);
    }
}

void PhotonEye::follow(const SampleId& id, Branch& at, int& event, const Wavelengths& waves,
                       Spectrum& sum, Spectrum& direct) {
    PathEnd& path = at.path;
    path.waves = &at.waves;
    const PathNumbers numbers{job_.round->seed, id.pixel.id(), id.number};
    while (true) {
        const PathMeets meets = next_.find(path, numbers);
        if (meets == PathMeets::Nothing) {
            sum += escaped(path, at.last);
            return;
        }
        if (meets == PathMeets::Volume) {
            if (at.last.scatterings < settings_.depth) {
                look_into_volume(id, event++, path, waves, sum, direct);
            }
            return;
        }
        const ShadingPoint& point = next_.point();
        sum += emitted(at);
        const bool deepest = at.last.scatterings >= settings_.depth;
        if (point.material->unlit) return;
        if (deepest && !next_.media().may_be_passed(*point.material)) return;
        scatter_.set(scene_, point, path.media, at.waves, false, nullptr, &next_.others(),
                     next_.sheet());
        if (deepest && !scatter_.may_be_passed()) return;
        if (scatter_.needs_hero()) at.waves.keep_hero(path.throughput);
        const int here = event;
        if (scatter_.has_density() && !deepest) {
            ++event;
            add_direct_light(id, here, at, waves, direct);
            const double times = at.straight ? photon_lookups(id) : 1.0;
            const PathNumbers own{numbers.seed + static_cast<std::uint64_t>(here) + 1, numbers.path,
                                  numbers.part};
            if (times > 0.0) {
                sum +=
                    times * path.throughput *
                    photon_light({point.surface, scatter_, path, id.number % given_.size(), own});
            }
        }
        bool goes_on = false;
        if (follow_both(id, event, at, goes_on)) {
            if (!goes_on) return;
            continue;
        }
        const auto drawn = scatter_.sample(random_.draw(id, here, PathRandomness::kChoices).x,
                                           random_.draw(id, here, PathRandomness::kDirection),
                                           Transport::Radiance);
        if (!drawn || drawn->weight.is_black() || (deepest && !drawn->straight)) return;
        if (!drawn->singular && !(drawn->density > kGlossyDensity)) return;
        // Mirrors and total reflection use no random numbers.
        const bool chosen = !(drawn->singular && is_certain(drawn->density));
        if (event == here && chosen) ++event;
        at.unlikely = at.unlikely || !(drawn->singular && drawn->density >= 0.5);
        if (!leave(id, event, *drawn, at)) return;
    }
}

bool PhotonEye::follow_both(const SampleId& id, int& event, Branch& at, bool& goes_on) {
    if (splits_ >= kMostSplits) return false;
    const auto ways = scatter_.both_ways(Transport::Radiance);
    if (!ways) return false;
    const auto share = [&](const Scattered& way) {
        const double eta = way.transmitted ? way.eta * way.eta : 1.0;
        return eta * at.last.eta_scale * (at.path.throughput * way.weight).max();
    };
    const std::size_t dim = share((*ways)[0]) < share((*ways)[1]) ? 0 : 1;
    const std::uint32_t samples = turns(at, share((*ways)[dim]));
    if (samples == 0) return false;
    if (is_turn(mix64(at.way ^ kTurn), id.number / at.stride, samples)) {
        ++splits_;
        Branch other = at;
        other.way = mix64(at.way ^ kDimWay);
        other.stride *= samples;
        Scattered way = (*ways)[dim];
        way.weight = samples * way.weight;
        if (leave(id, event, way, other)) waiting_.push_back(other);
    }
    at.way = mix64(at.way ^ kBrightWay);
    goes_on = leave(id, event, (*ways)[1 - dim], at);
    return true;
}

std::uint32_t PhotonEye::turns(const Branch& at, double share) const {
    if (share > settings_.split) return 1;
    // The wavelengths of samples also alternate.
    if (at.waves.is_spectral() || !(share > 0.0)) return 0;
    std::uint32_t samples = 2;
    while (at.stride * samples <= settings_.turns) {
        if (samples * share > settings_.split) return samples;
        samples *= 2;
    }
    return 0;
}

double PhotonEye::photon_lookups(const SampleId& id) const {
    if (settings_.every <= 1) return 1.0;
    const std::uint64_t key = mix64(job_.round->seed ^ mix64(id.pixel.id() ^ kLooks));
    return is_turn(key, id.number, settings_.every) ? settings_.every : 0.0;
}

bool PhotonEye::leave(const SampleId& id, int& event, const Scattered& drawn, Branch& at) const {
    const ShadingPoint& point = next_.point();
    at.straight = false;
    if (drawn.straight) {
        if (++at.path.met > kMaxPassedSurfaces) return false;
    } else {
        ++at.last.scatterings;
        at.last.singular = drawn.singular;
        at.last.density = drawn.density;
        at.last.from = {point.surface.point, scatter_.normal(), scatter_.is_lit_from_both_sides()};
        at.last.eta_scale *= drawn.transmitted ? drawn.eta * drawn.eta : 1.0;
    }
    NextSurface::go_on(at.path, point.surface, scatter_, drawn);
    if (drawn.dispersed) at.waves.keep_hero(at.path.throughput);
    return survives_roulette(at.path, at.last, id, event);
}

Spectrum PhotonEye::escaped(const PathEnd& path, const Last& last) const {
    const Spectrum light = path.throughput * lights_.environment(path.ray.direction, *path.waves);
    if (light.is_black() || last.singular) return light;
    const double other = lights_.environment_density(last.from, path.ray.direction);
    return weights_.of_hit(last.density, other) * light;
}

Spectrum PhotonEye::emitted(const Branch& at) const {
    const ShadingPoint& point = next_.point();
    const PathEnd& path = at.path;
    const Last& last = at.last;
    if (point.material->emission.is_black()) return {};
    const Spectrum light = path.throughput * emission_of(scene_, point, *path.waves);
    if (light.is_black()) return light;
    if (last.singular) {
        // One of `stride` samples carries the light of all. An unlikely branch with the light of
        // all would give bright outliers.
        const double times = at.unlikely ? 1.0 : at.stride;
        const double most = last.scatterings > 0 ? times * settings_.clamp : 0.0;
        return most > 0.0 && light.max() > most ? (most / light.max()) * light : light;
    }
    // Unlit surfaces show their colour and emit no light.
    if (point.material->unlit) return {};
    const double other =
        lights_.density(last.from, path.ray, next_.hit(), point.surface, path.travelled);
    return weights_.of_hit(last.density, other) * light;
}

Vec2 PhotonEye::draw_for_light(const SampleId& id, int event, const Branch& at,
                               PathRandomness::BouncePair pair) const {
    if (at.stride == 1) return random_.draw(id, event, pair);
    // The branches of a pixel use the same points, randomly shifted.
    const Vec2 u = random_.draw({id.pixel, id.number / at.stride}, 0, pair);
    const std::uint64_t key =
        mix64(at.way ^ mix64(kShift + pair) ^ static_cast<std::uint64_t>(at.last.scatterings));
    return {shifted(u.x + random_at(key, 0)), shifted(u.y + random_at(key, 1))};
}

void PhotonEye::add_direct_light(const SampleId& id, int event, const Branch& branch,
                                 const Wavelengths& waves, Spectrum& direct) {
    const double choice = draw_for_light(id, event, branch, PathRandomness::kChoices).y;
    const Vec2 place = draw_for_light(id, event, branch, PathRandomness::kLight);
    constexpr double kGolden = 0.6180339887498949;
    // Stratified over the choice of the light, and over the points of each chosen light.
    const double share = 1.0 / settings_.shadows;
    for (std::uint32_t k = 0; k < settings_.shadows; ++k) {
        const Vec2 shift{mirrored_bits(k), fraction(k * kGolden)};
        add_shadow_ray(branch, shifted(choice + share * k),
                       {shifted(place.x + shift.x), shifted(place.y + shift.y)}, share, waves,
                       direct);
    }
}

void PhotonEye::add_shadow_ray(const Branch& branch, double choice, const Vec2& place, double share,
                               const Wavelengths& waves, Spectrum& direct) {
    const PathEnd& path = branch.path;
    const ShadingPoint& point = next_.point();
    const LitPoint at{point.surface.point, scatter_.normal(), scatter_.is_lit_from_both_sides()};
    const LightDraw drawn = lights_.draw(at, choice, place, *path.waves);
    if (!(drawn.density > 0.0) || drawn.radiance.is_black()) return;
    const Spectrum light = scatter_.value(drawn.to_light, Transport::Radiance) * drawn.radiance;
    if (light.is_black()) return;
    double weight = share / drawn.density;
    const double other = drawn.singular ? 0.0 : scatter_.density(drawn.to_light);
    if (other > kGlossyDensity) weight *= weights_.of_shadow_ray(drawn.density, other);
    MediumStack media = path.media;
    if (dot(drawn.to_light, scatter_.geometric()) < 0.0) scatter_.cross(media);
    const Ray shadow = ray_to_light(lights_, at.point, leaving_ray(point.surface, drawn.to_light),
                                    drawn.distance, drawn.place, drawn.facing);
    shadows_.add(shadow, path.time, media, waves, path.throughput * (weight * light), direct);
}

PhotonEye::DirectLight PhotonEye::direct_light(const VolumePoint& at, double choice,
                                               const Vec2& place, const Wavelengths& waves) const {
    const LightDraw drawn = lights_.draw(LitPoint::inside_volume(at.point), choice, place, waves);
    if (!(drawn.density > 0.0)) return {};
    const double phase = henyey_greenstein(dot(at.along, drawn.to_light), at.anisotropy);
    return {(phase / drawn.density) * drawn.radiance,
            ray_to_light(lights_, at.point, {at.point, drawn.to_light}, drawn.distance, drawn.place,
                         drawn.facing)};
}

void PhotonEye::look_into_volume(const SampleId& id, int event, const PathEnd& path,
                                 const Wavelengths& waves, Spectrum& sum, Spectrum& direct) {
    const VolumePoint& at = next_.volume();
    sum += path.throughput * photon_light(SeenVolume{at, path, id.number % given_.size()});
    const DirectLight straight =
        direct_light(at, random_.draw(id, event, PathRandomness::kChoices).y,
                     random_.draw(id, event, PathRandomness::kLight), *path.waves);
    if (straight.light.is_black()) return;
    shadows_.add(straight.ray, path.time, path.media, waves, path.throughput * straight.light,
                 direct);
}

bool PhotonEye::survives_roulette(PathEnd& path, const Last& last, const SampleId& id,
                                  int& event) const {
    if (!path.throughput.is_finite()) return false;
    if (last.scatterings <= settings_.roulette) return true;
    // Branches that are followed with certainty are already dim. Bright paths continue: russian
    // roulette at each of many reflections inside glass would give bright outliers.
    const double light = last.eta_scale * path.throughput.max();
    if (!(light < settings_.split)) return true;
    const double share = light / settings_.split;
    if (!(random_.draw(id, event++, PathRandomness::kRoulette).x < share)) return false;
    path.throughput = (1.0 / share) * path.throughput;
    return true;
}

}  // namespace alhazen
