#include "alhazen/renderers/photons/next_surface.h"

#include <limits>
#include <optional>

#include "alhazen/renderers/light_transport/volume_scattering.h"
#include "alhazen/sampling/random.h"

namespace alhazen {

namespace {

/// First dimension for decisions about coverage.
constexpr std::uint64_t kCoverage = std::uint64_t{1} << 32;
/// First dimension for distances in volumes.
constexpr std::uint64_t kVolume = std::uint64_t{1} << 34;
/// First dimension for the ends of segments.
constexpr std::uint64_t kEndOfSegment = std::uint64_t{1} << 36;

}  // namespace

double PathNumbers::at(std::uint64_t dimension) const {
    return random_at(seed, path, part, dimension);
}

PathMeets NextSurface::find(PathEnd& path, const PathNumbers& numbers) {
    for (int passed = 0; passed <= kMaxPassedSurfaces; ++passed) {
        ++counters_[path.kind].cast;
        hit_ = Hit();
        path.passed = false;
        bool found = scene_.aggregate->closest(path.ray, hit_, {stats_, path.mask(), path.time});
        if (path.chooses && surfaces_.exist()) {
            const PassedSurfaces::Choice choice = surfaces_.choose(
                path.ray, path.time, numbers.at(kEndOfSegment + path.chosen++), found, hit_);
            found = found || choice.passed;
            path.passed = choice.passed;
            path.throughput = choice.weight * path.throughput;
        }
        if (!found) {
            const bool scattered =
                cross_medium(path, std::numeric_limits<double>::infinity(), numbers);
            return scattered ? PathMeets::Volume : PathMeets::Nothing;
        }
        ++counters_[path.kind].hit;
        if (cross_medium(path, hit_.t, numbers)) {
            return path.passed ? PathMeets::Nothing : PathMeets::Volume;
        }
        const Arrival arrival{!path.media.empty(), path.cone.width_at(hit_.t), path.time,
                              path.kind != RayKind::Eye};
        set_shading_point(scene_, path.ray, hit_, arrival, {}, point_);
        path.cone = path.cone.from(hit_.t);
        path.travelled += hit_.t;
        if (stops_here(path, arrival, numbers)) {
            const auto met = faces_.find(
                point_, {path.ray.direction, arrival, path.mask(), path.media, *path.waves},
                point_);
            if (met) hit_ = *met;
            return PathMeets::Surface;
        }
        if (path.passed) return PathMeets::Nothing;
        path.ray = beyond_;
    }
    return PathMeets::Nothing;
}

bool NextSurface::stops_here(PathEnd& path, const Arrival& arrival, const PathNumbers& numbers) {
    std::optional<HitAlong> back;
    for (const Hit* other = &hit_; other != nullptr; other = here_.next()) {
        const bool is_first = other == &hit_;
        if (!is_first) {
            hit_ = *other;
            Arrival onward = arrival;
            onward.inside = !path.media.empty();
            set_shading_point(scene_, here_.ray(), hit_, onward, {}, point_);
        }
        const double coverage = point_.material->coverage;
        const std::uint32_t number = path.met++;
        const bool stops = coverage >= 1.0 || numbers.at(kCoverage + number) < coverage;
        if (stops && (path.passed || !is_hit_from_behind(point_))) return true;
        if (path.passed) return false;
        if (is_first) {
            here_.find(point_.surface, hit_, path.ray, {stats_, path.mask(), path.time});
            beyond_ = leaving_ray(point_.surface, path.ray.direction);
        }
        if (stops) {
            if (!here_.any_left() && !back) return true;
            if (!back) back = {hit_, is_first ? path.ray : here_.ray()};
        } else if (media_.has_open_boundaries()) {
            opening_.set(scene_, point_, path.media, *path.waves);
            opening_.cross_opening(path.media);
        }
    }
    if (!back) return false;
    hit_ = back->hit;
    set_shading_point(scene_, back->ray, hit_, arrival, {}, point_);
    return true;
}

bool NextSurface::cross_medium(PathEnd& path, double length, const PathNumbers& numbers) {
    const Medium* const medium = path.media.here();
    if (medium == nullptr) return false;
    const Spectrum absorption = path.waves->absorption(medium->absorption);
    const VolumeScattering* const scattering = media_.in(*medium);
    if (scattering == nullptr) {
        path.throughput = path.throughput * transmittance(absorption, length);
        return false;
    }
    const std::uint64_t first = kVolume + 2 * std::uint64_t{path.stretch++};
    const VolumeStep step =
        step_in_volume(absorption, path.waves->absorption(scattering->coefficient), path.throughput,
                       length, {numbers.at(first), numbers.at(first + 1)});
    volume_ = {path.ray.at(step.distance), path.ray.direction, *medium, scattering->anisotropy,
               path.throughput * step.arrived};
    path.throughput = path.throughput * step.weight;
    if (!step.scatters) return false;
    path.cone = path.cone.from(step.distance);
    path.travelled += step.distance;
    return true;
}

void NextSurface::go_on_in_volume(PathEnd& path, const Vec2& u) const {
    const Vec3 direction = sample_henyey_greenstein(volume_.along, volume_.anisotropy, u);
    path.ray = {volume_.point, direction};
    path.kind = RayKind::Refraction;
    path.as_connection = false;
    path.travelled = 0.0;
}

void NextSurface::go_on(PathEnd& path, const ShapeSurface& at, const ScatterPoint& scatter,
                        const Scattered& drawn) {
    path.throughput = path.throughput * drawn.weight;
    if (drawn.transmitted) scatter.cross(path.media);
    path.ray = leaving_ray(at, drawn.direction);
    if (drawn.straight) return;
    path.kind = drawn.transmitted ? RayKind::Refraction : RayKind::Reflection;
    path.as_connection = false;
    path.travelled = 0.0;
}

}  // namespace alhazen
