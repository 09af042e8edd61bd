#include "alhazen/renderers/photons/photon_walk.h"

#include <algorithm>
#include <cmath>

#include "alhazen/sampling/random.h"

namespace alhazen {

namespace {

/// Number of random numbers per surface: lobe, direction, roulette.
constexpr std::uint64_t kAtEach = 4;
/// Dimension of the time of a photon.
constexpr std::uint64_t kTimeOfPhoton = std::uint64_t{1} << 31;
/// Dimension of the kind of the first segment.
constexpr std::uint64_t kFirstSegment = kTimeOfPhoton + 1;

/// Whether the squared distance to all others there is finite.
bool is_in_reach(const Vec3& p) {
    constexpr double kMost = 0x1p510;
    return std::abs(p.x) <= kMost && std::abs(p.y) <= kMost && std::abs(p.z) <= kMost;
}

}  // namespace

PhotonWalk::PhotonWalk(const Scene& scene, const Illumination& lights, const PhotonShot& shot,
                       RayCounters& counters, TraversalStats* stats)
    : scene_(scene),
      lights_(lights),
      shot_(shot),
      caustics_only_(!shot.kinds.has(PhotonKind::Direct) && !shot.kinds.has(PhotonKind::Indirect) &&
                     !shot.in_volumes.has(PhotonKind::Indirect)),
      sampler_(find_sampler("sobol")->make(shot.seed, kMaxSamples)),
      starts_(scene),
      next_(scene, counters, stats) {}

LightRay PhotonWalk::leave_light(std::uint64_t number) const {
    const SamplePixel set{static_cast<int>(number / kMaxSamples), 0};
    const auto in_set = static_cast<std::uint32_t>(number % kMaxSamples);
    const double choice = sampler_->at(set, 0, in_set).x;
    const Vec2 place = sampler_->at(set, 1, in_set), direction = sampler_->at(set, 2, in_set);
    return shot_.projection != nullptr
               ? shot_.projection->emit(choice, place, direction, *shot_.waves)
               : lights_.emit(choice, place, direction, *shot_.waves);
}

Spectrum PhotonWalk::falloff(const LightRay& light, const Vec3& point, double distance) const {
    if (!light.singular_place) return Spectrum::all(1);
    const Spectrum arrives = lights_.irradiance(light.place, point, *shot_.waves);
    Spectrum factor;
    for (int i = 0; i < Spectrum::kCount; ++i) {
        if (light.radiance[i] > 0.0)
            factor[i] = distance * distance * arrives[i] / light.radiance[i];
    }
    return factor;
}

void PhotonWalk::store(PhotonKind kind, const Spectrum& power, const Wavelengths& waves,
                       std::vector<Photon>& stored) const {
    if (!shot_.kinds.has(kind) || power.is_black() || !power.is_finite()) return;
    const Vec3& p = next_.point().surface.point;
    if (!is_in_reach(p)) return;
    // At a partly covering surface eye paths stop with the same probability as the photon.
    const double coverage = next_.point().material->coverage;
    const double share = 1.0 / (coverage * static_cast<double>(shot_.count));
    stored.push_back({{p.x, p.y, p.z},
                      stored_light(share * power, waves),
                      OctahedralVector(scatter_.view()),
                      OctahedralVector(scatter_.geometric())});
}

void PhotonWalk::store_in_volume(PhotonKind kind, const Spectrum& fluence, const Wavelengths& waves,
                                 std::vector<Photon>& stored) const {
    if (!shot_.in_volumes.has(kind) || fluence.is_black() || !fluence.is_finite()) return;
    const VolumePoint& at = next_.volume();
    if (!is_in_reach(at.point)) return;
    const double share = 1.0 / static_cast<double>(shot_.count);
    const Vec3& p = at.point;
    stored.push_back({{p.x, p.y, p.z},
                      stored_light(share * fluence, waves),
                      OctahedralVector(-at.along),
                      OctahedralVector::none()});
}

bool PhotonWalk::survives_roulette(PathEnd& path, const Spectrum& begun, const PathNumbers& numbers,
                                   std::uint64_t dimension) const {
    if (path.throughput.is_black()) return false;
    const double share = path.throughput.max() / begun.max();
    if (!(share < 1.0)) return path.throughput.is_finite();
    if (!(numbers.at(dimension) < share)) return false;
    path.throughput = (1.0 / share) * path.throughput;
    return true;
}

FirstSegment PhotonWalk::choose_first(PathEnd& path, const PathNumbers& numbers) const {
    if (caustics_only_) return FirstSegment::Hit;
    path.as_connection = numbers.at(kFirstSegment) < 0.5;
    path.throughput = 2.0 * path.throughput;
    return path.as_connection ? FirstSegment::Connected : FirstSegment::Hit;
}

bool PhotonWalk::shoot(std::uint64_t number, std::vector<Photon>& stored) {
    const PathNumbers numbers{shot_.seed, number, 0};
    const LightRay light = leave_light(number);
    float time = 0.0f;
    if (scene_.has_motion) time = shot_.shutter.at(numbers.at(kTimeOfPhoton));
    const WalkStart start = starts_.of(light, time, *shot_.waves);
    if (start.throughput.is_black() || !start.throughput.is_finite()) return false;
    PathEnd path;
    path.ray = start.ray;
    path.kind = RayKind::Reflection;
    path.as_connection = start.as_connection;
    path.chooses = true;
    Wavelengths waves = *shot_.waves;
    path.waves = &waves;
    path.throughput = start.throughput;
    path.time = time;
    path.media = start.media;
    FirstSegment first_segment = FirstSegment::Any;
    if (start.of_either) first_segment = choose_first(path, numbers);
    path.media.keep_seen_by(path.mask());
    Spectrum begun = path.throughput;
    Spectrum fall = Spectrum::all(1);
    PhotonKind kind = PhotonKind::Direct;
    int scatterings = 0;
    std::uint64_t event = 0;  // also counts thin sheets that are passed straight
    while (scatterings < shot_.depth) {
        const std::uint64_t first = kAtEach * event;
        const bool scattered = scatterings > 0;
        const PathMeets meets = next_.find(path, numbers);
        if (meets == PathMeets::Nothing) return true;
        const bool by_density = scattered || first_segment != FirstSegment::Hit;
        if (meets == PathMeets::Volume) {
            if (!by_density) return true;
            if (!scattered) fall = falloff(light, next_.volume().point, path.travelled);
            store_in_volume(kind, fall * next_.volume().arrived, waves, stored);
            if (caustics_only_) return true;
            kind = PhotonKind::Indirect;
            path.throughput = fall * path.throughput;
            begun = fall * begun;
            fall = Spectrum::all(1);
            ++scatterings;
            ++event;
            next_.go_on_in_volume(path, {numbers.at(first + 1), numbers.at(first + 2)});
            if (!survives_roulette(path, begun, numbers, first + 3)) return true;
            continue;
        }
        const ShadingPoint& point = next_.point();
        if (point.material->unlit) return true;
        if (!scattered) fall = falloff(light, point.surface.point, path.travelled);
        scatter_.set(scene_, point, path.media, waves, false, nullptr, &next_.others(),
                     next_.sheet());
        if (scatter_.is_null_boundary()) {
            // Passing straight through is no event.
            if (path.passed || path.met > kMaxPassedSurfaces) return true;
            NextSurface::go_on(path, point.surface, scatter_,
                               *scatter_.sample(0.0, {}, Transport::Importance));
            continue;
        }
        ++event;
        if (scatter_.needs_hero()) waves.keep_hero(path.throughput);
        const RayMask seen_by = next_.seen_by();
        if (by_density && scatter_.has_density() && (seen_by & kRaysOfPaths) != 0) {
            store(kind, fall * path.throughput, waves, stored);
        }
        const auto drawn =
            scatter_.sample(numbers.at(first), {numbers.at(first + 1), numbers.at(first + 2)},
                            Transport::Importance);
        if (!drawn || drawn->weight.is_black()) return true;
        const bool by_singular = scattered || first_segment != FirstSegment::Connected;
        if (path.passed && (drawn->straight || drawn->singular)) return true;
        if (drawn->straight && path.met > kMaxPassedSurfaces) return true;
        if (!drawn->straight && !(drawn->singular ? by_singular : by_density)) return true;
        const RayKind kind_of_next = drawn->transmitted ? RayKind::Refraction : RayKind::Reflection;
        if (!drawn->straight && (seen_by & mask_of(kind_of_next)) == 0) return true;
        if (!drawn->straight) {
            if (!drawn->singular) {
                if (caustics_only_) return true;
                kind = PhotonKind::Indirect;
            } else if (kind == PhotonKind::Direct) {
                kind = PhotonKind::Caustic;
            }
            path.throughput = fall * path.throughput;
            begun = fall * begun;
            fall = Spectrum::all(1);
            ++scatterings;
        }
        const double turned = scatter_.importance_correction(drawn->direction);
        NextSurface::go_on(path, point.surface, scatter_, *drawn);
        if (drawn->dispersed) waves.keep_hero(path.throughput);
        path.throughput = turned * path.throughput;
        if (!survives_roulette(path, begun, numbers, first + 3)) return true;
    }
    return true;
}

}  // namespace alhazen
