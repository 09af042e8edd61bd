#include "alhazen/renderers/photons/projection_map.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "alhazen/parallel/parallel.h"
#include "alhazen/renderers/light_transport/light_start.h"
#include "alhazen/renderers/photons/next_surface.h"
#include "alhazen/sampling/random.h"

namespace alhazen {

namespace {

constexpr double kBelowOne = 0x1.fffffffffffffp-1;
/// Share of the photons that go anywhere.
constexpr double kAnywhere = 0.1;
/// Lights that are told apart.
constexpr std::size_t kMostStrata = 64;

/// One trial: whether a ray of light meets what reflects or refracts in single directions.
bool meets_mirror(const RenderJob& job, const LightRay& light, const PathNumbers& numbers,
                  NextSurface& next, ScatterPoint& scatter) {
    const WalkStart start = start_of(light, 0.0f);
    if (start.throughput.is_black()) return false;
    PathEnd path;
    path.ray = start.ray;
    path.kind = RayKind::Reflection;
    if (!next.find(path, numbers) || next.point().material->unlit) return false;
    scatter.set(job.scene, next.point(), path.media);
    return scatter.has_singular();
}

}  // namespace

ProjectionMap::ProjectionMap(const RenderJob& job, const Illumination& lights, std::uint64_t seed,
                             RayCounters& counters) {
    std::set<std::size_t> sources;
    std::vector<std::uint8_t> afar;
    for (std::size_t i = 0; i < kMostStrata; ++i) {
        const LightRay light =
            lights.emit((static_cast<double>(i) + 0.5) / kMostStrata, {0.5, 0.5}, {0.5, 0.5});
        sources.insert(light.place.source);
        afar.push_back(light.infinite);
    }
    strata_ = sources.size() > 1 ? kMostStrata : 1;
    side_ = sources.size() > 1 ? 16 : 48;
    const std::size_t trials = sources.size() > 1 ? 4 : 16;
    afar.resize(strata_);
    afar_ = afar;
    std::vector<std::uint8_t> marks(cells());
    std::vector<RayCounters> counts(side_ * strata_);
    parallel_for(side_ * strata_, 1, [&](std::size_t begin, std::size_t end) {
        ScatterPoint scatter;
        for (std::size_t row = begin; row < end; ++row) {
            NextSurface next(job.scene, counts[row],
                             job.count_tests ? &counts[row].tests : nullptr);
            for (std::size_t cell = row * side_; cell < (row + 1) * side_; ++cell) {
                for (std::size_t k = 0; k < trials && marks[cell] == 0; ++k) {
                    const PathNumbers numbers{seed, cell, k};
                    const Aim tried = within(cell, numbers.at(0), {numbers.at(1), numbers.at(2)},
                                             {numbers.at(3), numbers.at(4)});
                    marks[cell] =
                        meets_mirror(job, lights.emit(tried.choice, tried.place, tried.direction),
                                     numbers, next, scatter);
                }
            }
        }
    });
    for (const RayCounters& c : counts) counters += c;
    widen(marks);
    marked_ = static_cast<std::size_t>(std::count(marks.begin(), marks.end(), 1));
    if (marked_ == 0) return;
    const double everywhere = kAnywhere / static_cast<double>(cells());
    for (const std::uint8_t mark : marks) {
        const double own =
            everywhere + (mark != 0 ? (1.0 - kAnywhere) / static_cast<double>(marked_) : 0.0);
        sums_.push_back((sums_.empty() ? 0.0 : sums_.back()) + own);
    }
}

/// Marks the neighbours of marked cells, too.
void ProjectionMap::widen(std::vector<std::uint8_t>& marks) const {
    const std::vector<std::uint8_t> own = marks;
    for (std::size_t cell = 0; cell < own.size(); ++cell) {
        if (own[cell] == 0) continue;
        const std::size_t stratum = cell / (side_ * side_);
        const std::size_t x = cell % side_, y = cell / side_ % side_;
        for (std::size_t v = y > 0 ? y - 1 : 0; v <= std::min(y + 1, side_ - 1); ++v) {
            for (std::size_t u = x > 0 ? x - 1 : 0; u <= std::min(x + 1, side_ - 1); ++u) {
                marks[(stratum * side_ + v) * side_ + u] = 1;
            }
        }
    }
}

ProjectionMap::Aim ProjectionMap::within(std::size_t cell, double choice, const Vec2& place,
                                         const Vec2& direction) const {
    const std::size_t stratum = cell / (side_ * side_);
    const auto part = [](std::size_t i, double u, std::size_t count) {
        return std::min((static_cast<double>(i) + u) / static_cast<double>(count), kBelowOne);
    };
    Aim aim{part(stratum, choice, strata_), place, direction, 1.0};
    Vec2& aimed = afar_[stratum] != 0 ? aim.place : aim.direction;
    aimed = {part(cell % side_, aimed.x, side_), part(cell / side_ % side_, aimed.y, side_)};
    return aim;
}

ProjectionMap::Aim ProjectionMap::aim(double choice, const Vec2& place,
                                      const Vec2& direction) const {
    if (marked_ == 0) return {choice, place, direction, 1.0};
    const double sought = choice * sums_.back();
    const auto found = std::upper_bound(sums_.begin(), sums_.end() - 1, sought);
    const auto cell = static_cast<std::size_t>(found - sums_.begin());
    const double before = cell > 0 ? sums_[cell - 1] : 0.0;
    const double share = *found - before;
    // What the choice of the cell leaves of the number chooses the light.
    const double rest = std::clamp((sought - before) / share, 0.0, kBelowOne);
    Aim aim = within(cell, rest, place, direction);
    aim.weight = sums_.back() / (static_cast<double>(cells()) * share);
    return aim;
}

}  // namespace alhazen
