#include "alhazen/renderers/photons/projection_map.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "alhazen/math/constants.h"
#include "alhazen/parallel/parallel.h"
#include "alhazen/renderers/core/sample_loop.h"
#include "alhazen/renderers/light_transport/light_starts.h"
#include "alhazen/renderers/photons/next_surface.h"
#include "alhazen/sampling/even_numbers.h"
#include "alhazen/sampling/random.h"

namespace alhazen {

namespace {

constexpr double kBelowOne = 0x1.fffffffffffffp-1;
/// Share of the photons emitted without restriction.
constexpr double kAnywhere = 0.2;
/// Numbers of strata of the choice of a light, for few lights and for many.
constexpr std::size_t kFewLights = 4, kFewStrata = 16, kMostStrata = 64;
/// A trial number that stands for all trials of a cell and is not used by any.
constexpr std::uint64_t kAllTrials = std::uint64_t{1} << 32;

/// Density of a cell by the share of its photons that hit: minimises variance times cost, if a miss
/// costs a twentieth of a hit.
float weight_of(double share) {
    constexpr double kMissing = 0.05;
    return static_cast<float>(std::sqrt(share / (share + kMissing)));
}

/// Time of a trial, stratified over the shutter for few trials.
float moment_of(const PathNumbers& numbers, std::uint32_t trial) {
    return ShutterPart{}.at(fraction(numbers.at(0) + mirrored_bits(trial)));
}

/// A trial: true if a ray of light meets a surface with a singular lobe.
bool meets_mirror(const Scene& scene, const LightRay& light, float time, const LightStarts& starts,
                  const PathNumbers& numbers, NextSurface& next, ScatterPoint& scatter) {
    const WalkStart start = starts.of(light, time, kColorChannels);
    if (start.throughput.is_black()) return false;
    PathEnd path;
    path.ray = start.ray;
    path.time = time;
    path.kind = RayKind::Reflection;
    path.as_connection = start.as_connection;
    // Ignores media, in which scattering would hide surfaces.
    if (next.find(path, numbers) != PathMeets::Surface || next.point().material->unlit) {
        return false;
    }
    scatter.set(scene, next.point(), path.media, kColorChannels, false, nullptr, &next.others(),
                next.sheet());
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
    std::vector<bool> afar(strata_);
    for (std::size_t i = 0; i < strata_; ++i) afar[i] = is_afar(i);
    const std::vector<float> weights = widened(tried(job, afar, seed, counters));
    double all = 0.0;
    for (const float w : weights) {
        all += static_cast<double>(w);
        marked_ += w > 0.0f ? 1 : 0;
    }
    if (marked_ == 0) return;
    const double even = 1.0 / static_cast<double>(cells());
    const std::size_t map = side_ * side_;
    const std::size_t near =
        map * static_cast<std::size_t>(std::count(afar.begin(), afar.end(), false));
    const double of_weight = (1.0 - kAnywhere) * static_cast<double>(near) * even / all;
    for (std::size_t cell = 0; cell < cells(); ++cell) {
        const double aimed = kAnywhere * even + of_weight * static_cast<double>(weights[cell]);
        const double own = afar[cell / map] ? even : aimed;
        sums_.push_back((sums_.empty() ? 0.0 : sums_.back()) + own);
    }
}

bool ProjectionMap::is_afar(std::size_t stratum) const {
    const double choice = (static_cast<double>(stratum) + 0.5) / static_cast<double>(strata_);
    return lights_.emit(choice, {0.5, 0.5}, {0.5, 0.5}, kColorChannels).infinite;
}

template <class Visit>
void ProjectionMap::for_neighbors(std::size_t cell, const Visit& visit) const {
    const std::size_t stratum = cell / (side_ * side_);
    const std::size_t x = cell % side_, y = cell / side_ % side_;
    for (std::size_t v = y > 0 ? y - 1 : 0; v <= std::min(y + 1, side_ - 1); ++v) {
        for (const std::size_t u : {(x + side_ - 1) % side_, x, (x + 1) % side_}) {
            visit((stratum * side_ + v) * side_ + u);
        }
    }
}

std::vector<std::size_t> ProjectionMap::leaders() const {
    std::map<std::size_t, std::size_t> first;  // first stratum of a light that fills strata alone
    std::vector<std::size_t> leader(strata_);
    for (std::size_t i = 0; i < strata_; ++i) {
        const auto source = [&](double share) {
            const double choice = (static_cast<double>(i) + share) / static_cast<double>(strata_);
            return lights_.emit(choice, {0.5, 0.5}, {0.5, 0.5}, kColorChannels).place.source;
        };
        constexpr double kEdge = 1e-6;
        const std::size_t lowest = source(kEdge);
        leader[i] = lowest == source(1.0 - kEdge) ? first.try_emplace(lowest, i).first->second : i;
    }
    return leader;
}

void ProjectionMap::try_cells(const RenderJob& job, const std::vector<std::size_t>& asked,
                              std::uint32_t trials, std::uint64_t seed, std::vector<Tally>& tallies,
                              RayCounters& counters) const {
    constexpr std::size_t kTogether = 64;
    const std::size_t groups = (asked.size() + kTogether - 1) / kTogether;
    const LightStarts starts(job.scene);
    std::vector<RayCounters> counts(groups);
    parallel_for(groups, 1, [&](std::size_t begin, std::size_t end) {
        ScatterPoint scatter;
        for (std::size_t g = begin; g < end; ++g) {
            NextSurface next(job.scene, counts[g], job.count_tests ? &counts[g].tests : nullptr);
            const std::size_t last = std::min((g + 1) * kTogether, asked.size());
            for (std::size_t i = g * kTogether; i < last; ++i) {
                Tally& tally = tallies[asked[i]];
                for (std::uint32_t k = 0; k < trials; ++k) {
                    const float time = job.scene.has_motion
                                           ? moment_of({seed, asked[i], kAllTrials}, tally.trials)
                                           : 0.0f;
                    const PathNumbers n{seed, asked[i], tally.trials++};
                    const LightRay light = emit_in(asked[i], 1.0, n.at(0), {n.at(1), n.at(2)},
                                                   {n.at(3), n.at(4)}, kColorChannels);
                    // Infinitely distant lights are not restricted.
                    const bool hits = light.infinite || meets_mirror(job.scene, light, time, starts,
                                                                     n, next, scatter);
                    tally.hits += hits ? 1 : 0;
                }
            }
        }
    });
    for (const RayCounters& c : counts) counters += c;
}

std::vector<ProjectionMap::Tally> ProjectionMap::shared(
    const std::vector<Tally>& own, const std::vector<std::size_t>& leader) const {
    const std::size_t map = side_ * side_;
    std::vector<Tally> tallies(cells());
    for (std::size_t cell = 0; cell < cells(); ++cell) {
        Tally& tally = tallies[leader[cell / map] * map + cell % map];
        tally.trials += own[cell].trials;
        tally.hits += own[cell].hits;
    }
    return tallies;
}

std::vector<float> ProjectionMap::tried(const RenderJob& job, const std::vector<bool>& afar,
                                        std::uint64_t seed, RayCounters& counters) const {
    const std::size_t map = side_ * side_;
    const std::vector<std::size_t> leader = leaders();
    std::vector<Tally> own(cells());
    std::vector<std::size_t> asked;
    for (std::size_t cell = 0; cell < cells(); ++cell) {
        if (!afar[cell / map]) asked.push_back(cell);
    }
    try_cells(job, asked, strata_ > 1 ? 4 : 16, seed, own, counters);
    std::vector<Tally> tallies = shared(own, leader);
    // More trials at hits and their neighbours, until the border is known.
    constexpr std::uint32_t kEnough = 64;
    while (true) {
        asked.clear();
        for (std::size_t cell = 0; cell < cells(); ++cell) {
            if (afar[cell / map] || leader[cell / map] != cell / map) continue;
            if (tallies[cell].trials >= kEnough) continue;
            bool near = tallies[cell].hits > 0;
            for_neighbors(cell, [&](std::size_t other) { near |= tallies[other].hits > 0; });
            if (near) asked.push_back(cell);
        }
        if (asked.empty()) break;
        try_cells(job, asked, kEnough, seed, own, counters);
        tallies = shared(own, leader);
    }
    std::vector<float> weights(cells());
    for (std::size_t cell = 0; cell < cells(); ++cell) {
        const Tally& tally = tallies[leader[cell / map] * map + cell % map];
        if (tally.hits > 0) weights[cell] = weight_of(tally.hits / double(tally.trials));
    }
    return weights;
}

std::vector<float> ProjectionMap::widened(const std::vector<float>& weights) const {
    constexpr double kLeastShare = 0.01;  // below the resolution of the trials
    const float least = weight_of(kLeastShare);
    std::vector<float> wide = weights;
    for (std::size_t cell = 0; cell < weights.size(); ++cell) {
        if (weights[cell] == 0.0f) continue;
        for_neighbors(cell, [&](std::size_t other) { wide[other] = std::max(wide[other], least); });
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
    // The halves of direction.x have selected the side of a two-sided light.
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
    // The remainder of the number after the choice of the cell selects the light.
    const double rest = std::clamp((sought - before) / own, 0.0, kBelowOne);
    const double share = own / sums_.back() * static_cast<double>(cells());
    return emit_in(cell, share, rest, place, direction, waves);
}

}  // namespace alhazen
