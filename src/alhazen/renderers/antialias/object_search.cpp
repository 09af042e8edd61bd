#include "alhazen/renderers/antialias/object_search.h"

#include <algorithm>
#include <array>
#include <atomic>

#include "alhazen/base/error.h"

namespace alhazen {

ObjectSearch::ObjectSearch(const Where& where, std::vector<std::uint8_t> met,
                           std::span<const WatchedObject> sought)
    : where_(where),
      corners_(static_cast<std::uint32_t>(where.grid.points().size())),
      met_(std::move(met)) {
    const std::uint32_t width = where.grid.width();
    for (const WatchedObject& s : sought) {
        if (cells_.empty() || cells_.back().pixel != s.pixel) {
            const int x = static_cast<int>(s.pixel % width), y = static_cast<int>(s.pixel / width);
            const AdaptiveGrid& grid = where.grid;
            cells_.push_back({{x, y},
                              {grid.corner_index(x, y), grid.corner_index(x + 1, y),
                               grid.corner_index(x, y + 1), grid.corner_index(x + 1, y + 1)},
                              s.pixel,
                              static_cast<std::uint32_t>(sought_.size()),
                              0});
        }
        ++cells_.back().sought;
        sought_.push_back(s.object);
    }
}

void ObjectSearch::run(AnswerPool& pool, const RenderJob& job) {
    for (int level = 0; !cells_.empty(); ++level) {
        choose(level);
        trace(pool);
        if (job.stop_requested()) return;
    }
    std::sort(below_depth_.begin(), below_depth_.end());
    below_depth_.erase(std::unique(below_depth_.begin(), below_depth_.end()), below_depth_.end());
}

/// Divides the cells of the level in which something is still sought; at the depth, records what is
/// left.
void ObjectSearch::choose(int level) {
    points_.clear();
    next_cells_.clear();
    next_sought_.clear();
    for (Cell cell : cells_) {
        const auto first = static_cast<std::uint32_t>(next_sought_.size());
        double farthest = 0.0;
        for (const std::uint32_t corner : cell.corners) {
            farthest = std::max(farthest, distance(corner));
        }
        for (std::uint32_t k = 0; k < cell.sought; ++k) {
            const std::uint32_t object = sought_[cell.first_sought + k];
            if (met_[object] == 0 && where_.spheres.may_hide(object, level, cell.at, farthest)) {
                next_sought_.push_back(object);
            }
        }
        cell.first_sought = first;
        cell.sought = static_cast<std::uint32_t>(next_sought_.size()) - first;
        if (cell.sought == 0) continue;
        if (level < where_.grid.depth()) {
            divide(cell, level + 1);
            continue;
        }
        for (std::uint32_t k = first; k < next_sought_.size(); ++k) {
            below_depth_.push_back({cell.pixel, next_sought_[k]});
        }
    }
    cells_.swap(next_cells_);
    sought_.swap(next_sought_);
    if (distances_.size() + points_.size() > AdaptiveGrid::kMostPoints) {
        throw Error(ErrorKind::Resource, "--antialias: too many rays; a smaller depth needs fewer");
    }
}

void ObjectSearch::divide(const Cell& cell, int level) {
    const int half = 1 << (where_.grid.depth() - level);
    const std::int32_t x = 2 * cell.at.x, y = 2 * cell.at.y;
    const auto add = [&](std::int32_t dx, std::int32_t dy) {
        const GridPoint p{half * (x + dx), half * (y + dy)};
        const auto fresh = static_cast<std::uint32_t>(distances_.size() + points_.size());
        const std::uint32_t ray = rays_.find_or_add(grid_key(0, p), fresh);
        if (ray == fresh) {
            points_.push_back(p);
            pixels_.push_back(cell.pixel);
        }
        return corners_ + ray;
    };
    const std::uint32_t* c = cell.corners;
    const std::uint32_t up = add(1, 0), left = add(0, 1), middle = add(1, 1), right = add(2, 1),
                        down = add(1, 2);
    const std::uint32_t children[4][4] = {{c[0], up, left, middle},
                                          {up, c[1], middle, right},
                                          {left, middle, c[2], down},
                                          {middle, right, down, c[3]}};
    for (int k = 0; k < 4; ++k) {
        Cell& child = next_cells_.emplace_back(cell);
        child.at = {x + (k & 1), y + (k >> 1)};
        std::copy_n(children[k], 4, child.corners);
    }
}

/// Traces the rays of this level.
void ObjectSearch::trace(AnswerPool& pool) {
    const std::size_t before = distances_.size();
    distances_.resize(before + points_.size());
    hits_.resize(distances_.size());
    pool.trace(points_.size(), [&](RayAnswers& answers, std::size_t first, std::size_t count,
                                   RayCounters& counters) {
        std::array<Ray, RayAnswers::kRaysAtOnce> rays;
        std::vector<Hit> hits(count);
        where_.picture.rays(where_.grid.depth(), std::span(points_).subspan(first, count), rays);
        answers.find(std::span(rays).first(count), hits, counters);
        for (std::size_t i = 0; i < count; ++i) {
            distances_[before + first + i] = hits[i].t;
            hits_.set(before + first + i, hits[i]);
            if (!hits[i].found()) continue;
            std::atomic_ref<std::uint8_t>(met_[where_.objects.number_of(hits[i])])
                .store(1, std::memory_order_relaxed);
        }
    });
}

}  // namespace alhazen
