#include "alhazen/renderers/photons/projection_map.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "alhazen/math/constants.h"
#include "alhazen/parallel/parallel.h"
#include "alhazen/renderers/light_transport/light_start.h"
#include "alhazen/renderers/photons/next_surface.h"
#include "alhazen/sampling/random.h"

namespace alhazen {

namespace {

constexpr double kBelowOne = 0x1.fffffffffffffp-1;
/// Share of the photons that go anywhere.
constexpr double kAnywhere = 0.2;
/// Parts of the choice among few lights, and among many.
constexpr std::size_t kFewLights = 4, kFewStrata = 16, kMostStrata = 64;

/// One trial: whether a ray of light meets what reflects or refracts in single directions.
bool meets_mirror(const Scene& scene, const LightRay& light, const MediaFinder& media,
                  const PathNumbers& numbers, NextSurface& next, ScatterPoint& scatter) {
    const WalkStart start = start_of(light, 0.0f, media, kColorChannels);
    if (start.throughput.is_black()) return false;
    PathEnd path;
    path.ray = start.ray;
    path.kind = RayKind::Reflection;
    // Without media: one that scatters would hide what lies beyond.
    if (next.find(path, numbers) != PathMeets::Surface || next.point().material->unlit) {
        return false;
    }
    scatter.set(scene, next.point(), path.media, kColorChannels);
    return scatter.has_singular();
}

}  // namespace

ProjectionMap::ProjectionMap(const RenderJob& job, const Illumination& lights, std::uint64_t seed,
                             RayCounters& counters)
    : lights_(lights) {
    std::set<std::size_t> sources;
    for (std::size_t i = 0; i < kMostStrata; ++i) {
        const double choice = (static_cast<double>(i) + 0.5) / kMostStrata;
        sources.insert(lights.emit(choice, {0.5, 0.5}, {0.5, 0.5}, kColorChannels).place.source);
    }
    strata_ = sources.size() == 1 ? 1 : sources.size() <= kFewLights ? kFewStrata : kMostStrata;
    side_ = sources.size() == 1 ? 96 : sources.size() <= kFewLights ? 64 : 32;
    const std::vector<std::uint8_t> marks = widened(tried(job, seed, counters));
    marked_ = static_cast<std::size_t>(std::count(marks.begin(), marks.end(), 1));
    if (marked_ == 0) return;
    const double even = 1.0 / static_cast<double>(cells());
    std::vector<bool> afar(strata_);
    for (std::size_t i = 0; i < strata_; ++i) afar[i] = is_afar(i);
    const std::size_t map = side_ * side_;
    const std::size_t near =
        map * static_cast<std::size_t>(std::count(afar.begin(), afar.end(), false));
    const double of_marked =
        (1.0 - kAnywhere) * static_cast<double>(near) * even / static_cast<double>(marked_);
    for (std::size_t cell = 0; cell < cells(); ++cell) {
        const double aimed = kAnywhere * even + (marks[cell] != 0 ? of_marked : 0.0);
        const double own = afar[cell / map] ? even : aimed;
        sums_.push_back((sums_.empty() ? 0.0 : sums_.back()) + own);
    }
}

bool ProjectionMap::is_afar(std::size_t stratum) const {
    const double choice = (static_cast<double>(stratum) + 0.5) / static_cast<double>(strata_);
    return lights_.emit(choice, {0.5, 0.5}, {0.5, 0.5}, kColorChannels).infinite;
}

std::vector<std::uint8_t> ProjectionMap::tried(const RenderJob& job, std::uint64_t seed,
                                               RayCounters& counters) const {
    const int trials = strata_ > 1 ? 4 : 16;
    std::vector<std::uint8_t> marks(cells());
    std::vector<RayCounters> counts(strata_ * side_);
    const MediaFinder media(job.scene);
    parallel_for(counts.size(), 1, [&](std::size_t begin, std::size_t end) {
        ScatterPoint scatter;
        for (std::size_t row = begin; row < end; ++row) {
            NextSurface next(job.scene, counts[row],
                             job.count_tests ? &counts[row].tests : nullptr);
            if (is_afar(row / side_)) continue;
            for (std::size_t cell = row * side_; cell < (row + 1) * side_; ++cell) {
                for (int k = 0; k < trials && marks[cell] == 0; ++k) {
                    const PathNumbers n{seed, cell, static_cast<std::uint64_t>(k)};
                    const LightRay light = emit_in(cell, 1.0, n.at(0), {n.at(1), n.at(2)},
                                                   {n.at(3), n.at(4)}, kColorChannels);
                    // Light without a place is sent everywhere.
                    marks[cell] =
                        light.infinite || meets_mirror(job.scene, light, media, n, next, scatter);
                }
            }
        }
    });
    for (const RayCounters& c : counts) counters += c;
    return marks;
}

std::vector<std::uint8_t> ProjectionMap::widened(const std::vector<std::uint8_t>& marks) const {
    std::vector<std::uint8_t> wide = marks;
    for (std::size_t cell = 0; cell < marks.size(); ++cell) {
        if (marks[cell] == 0) continue;
        const std::size_t stratum = cell / (side_ * side_);
        const std::size_t x = cell % side_, y = cell / side_ % side_;
        for (std::size_t v = y > 0 ? y - 1 : 0; v <= std::min(y + 1, side_ - 1); ++v) {
            for (const std::size_t u : {(x + side_ - 1) % side_, x, (x + 1) % side_}) {
                wide[(stratum * side_ + v) * side_ + u] = 1;
            }
        }
    }
    return wide;
}

LightRay ProjectionMap::emit_in(std::size_t cell, double share, double choice, const Vec2& place,
                                const Vec2& direction, const Wavelengths& waves) const {
    const std::size_t stratum = cell / (side_ * side_);
    LightRay light = lights_.emit(
        std::min((static_cast<double>(stratum) + choice) / static_cast<double>(strata_), kBelowOne),
        place, direction, waves);
    if (!(light.place_density > 0.0)) return light;
    if (light.infinite) {
        light.place_density *= share;
        return light;
    }
    // The side of a lamp with two was chosen by the halves of direction.x.
    const double doubled = 2.0 * direction.x;
    const double side = static_cast<double>(side_);
    const double angle =
        2.0 * kPi * (static_cast<double>(cell % side_) + doubled - std::floor(doubled)) / side;
    const double z = 1.0 - 2.0 * (static_cast<double>(cell / side_ % side_) + direction.y) / side;
    const double across = std::sqrt(std::max(0.0, 1.0 - z * z));
    const Vec3 along = normalize(Vec3{across * std::cos(angle), across * std::sin(angle), z});
    const double aimed = share / (4.0 * kPi);
    if (light.singular_place) {
        light.radiance = lights_.irradiance(light.place, light.ray.origin + along, waves);
        light.direction_density = aimed;
        light.normal = along;
    } else {
        const double cosine = dot(light.ray.direction, light.normal);
        const bool two_sides = light.direction_density * kPi < 0.75 * cosine;
        light.direction_density = two_sides ? 0.5 * aimed : aimed;
        if (!(dot(along, light.normal) > 0.0)) light.place_density = 0.0;
    }
    light.ray.direction = along;
    return light;
}

LightRay ProjectionMap::emit(double choice, const Vec2& place, const Vec2& direction,
                             const Wavelengths& waves) const {
    if (sums_.empty()) return lights_.emit(choice, place, direction, waves);
    const double sought = choice * sums_.back();
    const auto found = std::upper_bound(sums_.begin(), sums_.end() - 1, sought);
    const auto cell = static_cast<std::size_t>(found - sums_.begin());
    const double before = cell > 0 ? sums_[cell - 1] : 0.0;
    const double own = *found - before;
    // What the choice of the cell leaves of the number chooses the light.
    const double rest = std::clamp((sought - before) / own, 0.0, kBelowOne);
    const double share = own / sums_.back() * static_cast<double>(cells());
    return emit_in(cell, share, rest, place, direction, waves);
}

}  // namespace alhazen
